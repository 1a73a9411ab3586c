#include "app/files/data_path.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace app {

namespace fs = std::filesystem;

std::string dataFolder() {
  if (const char* folder = std::getenv("HAIRMESH_DATA"); folder && *folder) return folder;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed = (program.parent_path() / HAIRMESH_INSTALLED_DATA).lexically_normal();
  return fs::is_directory(installed / "shaders", ignored) ? installed.string() : HAIRMESH_SOURCE_DIR;
}

std::string dataPath(const std::string& relative) {
  return (fs::path(dataFolder()) / relative).string();
}

std::string findFile(const std::string& name, const std::string& base_file, const std::string& kind) {
  const fs::path given(name);
  if (given.is_absolute()) return name;
  const fs::path beside = base_file.empty() ? given : fs::path(base_file).parent_path() / given;
  std::error_code ignored;
  for (const fs::path& candidate :
       {beside, fs::path(dataFolder()) / given, fs::path(dataFolder()) / "assets" / kind / given}) {
    if (fs::exists(candidate, ignored)) return candidate.lexically_normal().string();
  }
  return name;
}

std::vector<std::string> listAssets(const std::string& kind, const std::vector<std::string>& endings) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(dataPath("assets/" + kind), ignored)) {
    const std::string ending = entry.path().extension().string();
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string stem(const std::string& path) {
  return fs::path(path).stem().string();
}

}  // namespace app
