#include "app/platform/video.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "sim/field_text.h"

namespace app {

namespace {

namespace fs = std::filesystem;

// Beside the film, and with the ending that it was named by: ffmpeg takes the format from that.
std::string unfinishedName(const std::string& file) {
  const fs::path path(file);
  return (fs::path(fileBehindLinks(file)).parent_path() /
          ("." + path.stem().string() + "-" + std::to_string(getpid()) + path.extension().string()))
      .string();
}

std::vector<std::string> ffmpegWords(const std::string& file, int width, int height, double fps) {
  // Most players want an even number of rows and columns, and colours at half of them.
  return {"ffmpeg",
          "-loglevel",
          "error",
          "-xerror",
          "-y",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgba",
          "-video_size",
          std::to_string(width) + "x" + std::to_string(height),
          "-framerate",
          sim::numberText(fps),
          "-i",
          "-",
          "-vf",
          "scale=ceil(iw/2)*2:ceil(ih/2)*2",
          "-pix_fmt",
          "yuv420p",
          file};
}

// In the child: the frames come in, only faults go out, and an interrupt of the program is the program's affair.
[[noreturn]] void becomeFfmpeg(int frames, int faults, std::vector<std::string> words) {
  setpgid(0, 0);
  dup2(frames, 0);
  dup2(open("/dev/null", O_WRONLY), 1);
  dup2(faults, 2);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp("ffmpeg", arguments.data());
  _exit(127);
}

}  // namespace

bool canWriteVideo() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((fs::path(folder) / "ffmpeg").c_str(), X_OK) == 0) return true;
  }
  return false;
}

VideoWriter::VideoWriter(const std::string& file, int width, int height, double fps)
    : file_(file), unfinished_(unfinishedName(file)), width_(width), height_(height) {
  if (!canWriteVideo())
    throw OutputError(file, "needs ffmpeg, which is not installed",
                      "apt-get install ffmpeg, or keep the frames as PNG with --out DIR");
  checkWritable(file);
  signal(SIGPIPE, SIG_IGN);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw OutputError(file, "cannot be handed to ffmpeg", "try again");
  faults_ = memfd_create("faults", MFD_CLOEXEC);
  std::vector<std::string> words = ffmpegWords(unfinished_, width, height, fps);
  process_ = fork();
  if (process_ == 0) becomeFfmpeg(ends[0], faults_, std::move(words));
  ::close(ends[0]);
  pipe_ = ends[1];
  if (process_ < 0) throw OutputError(file, "cannot be handed to ffmpeg", "try again");
}

VideoWriter::~VideoWriter() {
  if (process_ > 0) close();
  ::close(faults_);
  std::error_code ignored;
  fs::remove(unfinished_, ignored);
}

void VideoWriter::add(std::span<const unsigned char> rgba) {
  while (!rgba.empty()) {
    const ssize_t written = write(pipe_, rgba.data(), rgba.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      close();
      refuse("was given up by ffmpeg");
    }
    rgba = rgba.subspan(static_cast<std::size_t>(written));
  }
}

std::string VideoWriter::sizeNote() const {
  const int width = (width_ + 1) / 2 * 2, height = (height_ + 1) / 2 * 2;
  if (width == width_ && height == height_) return "";
  const auto text = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
  return "; its pictures are " + text(width, height) + ", not " + text(width_, height_) +
         ": a film's sides are even, so black was added at the right or below";
}

int VideoWriter::close() {
  ::close(std::exchange(pipe_, -1));
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
  return status;
}

void VideoWriter::refuse(const char* what) const {
  const std::string words = faultWords();
  throw OutputError(file_, what + (words.empty() ? "" : " (" + words + ")"),
                    "check the disk, and the ending: .mp4, .webm or .mkv");
}

std::string VideoWriter::faultWords() const {
  std::array<char, 400> text{};
  const ssize_t length = pread(faults_, text.data(), text.size(), 0);
  std::string first;
  std::getline(std::istringstream(std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0)))),
               first);
  return first;
}

void VideoWriter::finish() {
  std::error_code error;
  if (close() != 0 || !faultWords().empty() || (fs::rename(unfinished_, fileBehindLinks(file_), error), error))
    refuse("could not be finished by ffmpeg");
}

}  // namespace app
