// Files that the program writes: whole or not at all.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace app {

// Written to FILE.part beside it, and renamed once all of it is on the disk: whatever fails, FILE is what it was before
// or all of the new one. Devices and pipes are written directly.
class OutputFile {
 public:
  // Throws OutputError where the file cannot be made.
  explicit OutputFile(const std::string& file);
  // Without commit nothing is left behind.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Each throws OutputError when the bytes could not be written.
  void write(std::string_view bytes);
  // Puts bytes in place of some that were written, at an offset from the file's start; writing goes on at the end.
  void overwrite(long at, std::string_view bytes);
  void flush();
  void commit();

 private:
  [[noreturn]] void fail(int error);

  std::string file_;       // as a person named it
  std::string target_;     // what a link leads to
  std::string temporary_;  // empty: written directly
  std::FILE* stream_ = nullptr;
};

// A folder for what a run writes, made with those above it where they are missing. Of those that it has made nothing
// stays that is empty in the end.
class OutputFolder {
 public:
  // Throws OutputError with `mend` where it cannot be made.
  OutputFolder(const std::string& folder, const std::string& mend);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::vector<std::string> made_;  // the innermost first
};

// The whole of a file at once. Throws OutputError.
void writeFile(const std::string& file, std::string_view bytes);

// From now on a file that passes the process's limit (ulimit -f) fails as on a full disk: without this a signal ends
// the program.
void failAtFileLimit();

// The file that a link leads to, whether or not it is there yet. A link stays itself where it leads round, or to what
// has no path: /dev/stdout to a pipe.
std::string fileBehindLinks(const std::string& file);

// Throws OutputError when the file cannot be written, before a long run finds that out at its end. What is there stays.
void checkWritable(const std::string& file);

}  // namespace app
