#include "app/figure/uri_files.h"

#include <charconv>
#include <filesystem>
#include <system_error>

namespace app {

std::string fileOfUri(const std::string& name) {
  std::error_code ignored;
  if (std::filesystem::exists(name, ignored)) return name;
  std::string decoded;
  for (std::size_t at = 0; at < name.size(); ++at) {
    unsigned char byte = 0;
    const char* digits = name.data() + at + 1;
    const bool coded = name[at] == '%' && at + 2 < name.size() &&
                       std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2 && byte != 0;
    decoded.push_back(coded ? static_cast<char>(byte) : name[at]);
    at += coded ? 2 : 0;
  }
  return std::filesystem::exists(decoded, ignored) ? decoded : name;
}

bool UriFiles::Exists(const char* name) const {
  return DefaultIOSystem::Exists(fileOfUri(name).c_str());
}

Assimp::IOStream* UriFiles::Open(const char* name, const char* mode) {
  return DefaultIOSystem::Open(fileOfUri(name).c_str(), mode);
}

}  // namespace app
