# The Debian and Ubuntu packages that the project needs, in one place for ./run and ./test, and how they are installed.
# Sourced, not run.

build_packages=(
  g++ cmake ninja-build pkg-config
  libeigen3-dev libglfw3-dev libglew-dev libgl-dev libegl-dev libassimp-dev libcli11-dev nlohmann-json3-dev libimgui-dev libstb-dev
  libgl1-mesa-dri libegl1 fonts-roboto-unhinted
)
test_packages=(libgtest-dev libpng-dev xvfb python3)
# More tests and comparisons run where these are installed; without them they are skipped.
optional_test_packages=(libembree-dev assimp-testmodels libsuitesparse-dev libbullet-dev gnuplot-nox valgrind clang libclang-rt-14-dev
  glslang-tools mesa-vulkan-drivers
  # the Python package; the plots and the studies over it; the pages of include/hairmesh.h
  python3-numpy python3-matplotlib python3-distributed doxygen
  # films of --video
  ffmpeg)

installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# Installs what is missing of the packages named; says what it does, and asks for root only when there is something to do.
install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    echo "This is not a Debian or Ubuntu system: please install yourself what corresponds to: $*" >&2
    return 0
  fi
  local missing=() package root=()
  for package in "$@"; do
    installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "Installing with apt-get: ${missing[*]}" >&2
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "That needs root, and there is no sudo. As root, run: apt-get install ${missing[*]}" >&2
      return 1
    fi
    echo "(with sudo, for this step only)" >&2
    root=(sudo)
  fi
  local apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300)
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2 && return 0
  echo "Refreshing the package lists and trying once more" >&2
  "${apt[@]}" update >&2 && "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2
}

# Those of the packages named that this system's archives know.
known_packages() {
  local package
  for package in "$@"; do
    if [ -n "$(apt-cache --quiet=0 show "$package" 2>/dev/null)" ]; then echo "$package"; fi
  done
}

# configure FOLDER ON|OFF [OPTION...]: configures a Release build, with or without the tests. The sources of a folder are compiled as one.
configure() {
  local generator=()
  if [ ! -f "$1/CMakeCache.txt" ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
  cmake -S . -B "$1" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DHAIRMESH_TESTS="$2" "${@:3}" >"$1.log" 2>&1 && return 0
  cat "$1.log" >&2
  return 1
}
