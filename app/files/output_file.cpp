#include "app/files/output_file.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>

#include "app/files/errors.h"

namespace app {

namespace fs = std::filesystem;

std::string fileBehindLinks(const std::string& file) {
  constexpr int kMostLinks = 40;  // as the system follows
  std::error_code ignored;
  fs::path path = file;
  const bool there = fs::exists(path, ignored);
  for (int k = 0; k < kMostLinks && fs::is_symlink(path, ignored); ++k)
    path = path.parent_path() / fs::read_symlink(path, ignored);
  return fs::is_symlink(path, ignored) || fs::exists(path, ignored) != there ? file : path.string();
}

OutputFile::OutputFile(const std::string& file) : file_(file), target_(fileBehindLinks(file)) {
  std::error_code ignored;
  if (fs::is_directory(target_, ignored)) fail(EISDIR);
  const bool direct = fs::exists(target_, ignored) && !fs::is_regular_file(target_, ignored);
  if (!direct) temporary_ = target_ + ".part";
  stream_ = std::fopen((direct ? target_ : temporary_).c_str(), "wb");
  if (stream_) return;
  temporary_.clear();  // there is none to remove
  fail(errno);
}

OutputFile::~OutputFile() {
  if (stream_) std::fclose(stream_);
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void OutputFile::write(std::string_view bytes) {
  if (bytes.empty()) return;  // its data may be null, which fwrite must not be given
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) fail(errno);
}

void OutputFile::overwrite(long at, std::string_view bytes) {
  if (std::fseek(stream_, at, SEEK_SET) != 0) fail(errno);
  write(bytes);
  if (std::fseek(stream_, 0, SEEK_END) != 0) fail(errno);
}

void OutputFile::flush() {
  if (std::fflush(stream_) != 0) fail(errno);
}

void OutputFile::commit() {
  flush();
  // Some file systems report a full disk only here.
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) fail(errno);
  if (temporary_.empty()) return;
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error.value() == ENOENT)
    throw OutputError(file_, "was written by another run at the same time", "give every run a name of its own");
  if (error) fail(error.value());
  temporary_.clear();
}

void OutputFile::fail(int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw OutputError(file_, std::string("cannot be written: ") + std::strerror(error),
                    full                    ? "make room, or choose another folder"
                    : error == EISDIR       ? "add a file's name to the folder"
                    : error == ENAMETOOLONG ? "choose a shorter name"
                                            : "choose a folder that exists and may be written to");
}

OutputFolder::OutputFolder(const std::string& folder, const std::string& mend) {
  std::error_code error, ignored;
  for (fs::path path = fs::absolute(folder, ignored).lexically_normal(); !fs::exists(path, ignored);
       path = path.parent_path()) {
    if (path.has_filename()) made_.push_back(path.string());
    if (path == path.parent_path()) break;
  }
  fs::create_directories(folder, error);
  if (fs::is_directory(folder, ignored)) return;
  made_.clear();
  throw OutputError(folder, "is not a folder and cannot be made one: " + error.message(), mend);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (const std::string& path : made_) fs::remove(path, ignored);  // none that holds something
}

void writeFile(const std::string& file, std::string_view bytes) {
  OutputFile output(file);
  output.write(bytes);
  output.commit();
}

void failAtFileLimit() {
  std::signal(SIGXFSZ, SIG_IGN);
}

void checkWritable(const std::string& file) {
  const OutputFile output(file);
}

}  // namespace app
