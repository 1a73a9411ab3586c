// Files that a measurement writes: tried before it begins, and checked when they are written.
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

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
    stream_.close();
    if (std::error_code error; std::filesystem::file_size(file_, error) == 0) std::filesystem::remove(file_, error);
    throw app::OutputError(file_, "cannot be written" + why, "make room, or choose another file");
  }
  bool wanted() const { return !file_.empty(); }

 private:
  std::string file_;
  std::ofstream stream_;
};

}  // namespace bench
