// Files that a measurement writes: tried before it begins, and checked when they are written.
#pragma once

#include <sys/wait.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "app/files/errors.h"
#include "app/files/output_file.h"

namespace bench {

// Throws app::OutputError with `mend` where the file, or a missing folder above it, cannot be made. Leaves nothing.
inline void checkNewFile(const std::string& file, const std::string& mend) {
  std::optional<app::OutputFolder> folder;
  if (const auto parent = std::filesystem::path(file).parent_path(); !parent.empty())
    folder.emplace(parent.string(), mend);
  app::checkWritable(file);
}

// A folder for what is written, made where it is missing. Throws app::OutputError with `mend`.
inline void makeFolder(const std::string& folder, const std::string& mend) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, error))
    throw app::OutputError(folder, "is not a folder and cannot be made one", mend);
}

// A file that grows while it is measured: a run that is cut short leaves what it has. Throws app::OutputError.
class RowFile {
 public:
  // No name: nothing is written.
  RowFile(const std::string& file, const std::string& head) : file_(file) {
    if (file_.empty()) return;
    app::checkWritable(file_);
    stream_.open(file_);
    add(head);
  }
  void add(const std::string& rows) {
    if (file_.empty()) return;
    errno = 0;
    stream_ << rows << std::flush;
    if (stream_) return;
    const std::string why = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
    throw app::OutputError(file_, "cannot be written" + why, "make room, or choose another file");
  }
  bool wanted() const { return !file_.empty(); }

 private:
  std::string file_;
  std::ofstream stream_;
};

// Whether an SVG or PNG picture has its end.
inline bool isWholePicture(const std::string& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  constexpr std::streamoff kEnd = 32;  // bytes; both endings are shorter
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : 0;
  if (size <= kEnd) return false;
  std::string end(static_cast<std::size_t>(kEnd), 0);
  stream.seekg(size - kEnd);
  stream.read(end.data(), kEnd);
  return end.find(file.ends_with(".svg") ? "</svg>" : "IEND") != std::string::npos;
}

// Writes the script, has gnuplot draw the pictures and removes the script. Where gnuplot is not installed or ends with
// a fault it says so and goes on. Throws app::OutputError where the script cannot be written or, as on a full disk, a
// picture is cut, which gnuplot does not tell.
inline void runGnuplot(const std::string& script, const std::string& text, const std::vector<std::string>& pictures) {
  constexpr int kNoSuchProgram = 127;  // of the shell
  app::writeFile(script, text);
  std::fflush(stdout);
  const int status = std::system(("gnuplot '" + script + "' 2>&1").c_str());
  std::error_code ignored;
  std::filesystem::remove(script, ignored);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  for (const std::string& picture : pictures) {
    if (code == kNoSuchProgram)
      std::printf("no chart %s: gnuplot is not installed; install it and run this again\n", picture.c_str());
    else if (code != 0)
      std::printf("no chart %s: gnuplot failed, by what it says above\n", picture.c_str());
    else if (!isWholePicture(picture))
      throw app::OutputError(picture, "could not be written whole by gnuplot", "make room, or choose another folder");
  }
}

}  // namespace bench
