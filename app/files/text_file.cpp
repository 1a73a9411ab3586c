#include "app/files/text_file.h"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "app/files/errors.h"

namespace app {

std::string readText(const std::string& file, std::size_t limit_bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (file.empty() || !fs::exists(status)) {
    throw InputError(file, "", "there is no such file", "check the path");
  }
  if (fs::is_directory(status)) throw InputError(file, "", "this is a folder, not a file", "name a file inside it");
  // A pipe without a writer would hang the program, a device would never end.
  if (!fs::is_regular_file(status)) throw InputError(file, "", "this is a pipe or a device", "name a regular file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file, "", "the file cannot be opened", "check its permissions");

  // Read in blocks instead of trusting the size: the file may grow meanwhile.
  std::string text;
  std::string block(std::size_t{1} << 20, '\0');
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block, 0, static_cast<std::size_t>(stream.gcount()));
    if (text.size() > limit_bytes) {
      throw InputError(file, "", "the file is larger than " + std::to_string(limit_bytes) + " bytes",
                       "cut it into smaller pieces");
    }
  }
  if (stream.bad()) throw InputError(file, "", "the file cannot be read", "check the disk and the permissions");
  if (text.empty()) throw InputError(file, "", "the file is empty", "give a file with content");
  return text;
}

}  // namespace app
