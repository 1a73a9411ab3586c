// Fuzz target: curves from a .usda file, at two moments, and the moments' times.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/groom/formats/usda_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    app::readUsda(bytes, "fuzz.usda");
    app::readUsda(bytes, "fuzz.usda", 1);
    app::usdaTimes(bytes, "fuzz.usda");
  } catch (const app::InputError&) {
  }
  return 0;
}
