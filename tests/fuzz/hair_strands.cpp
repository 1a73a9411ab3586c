// Fuzz target: strands from a .hair file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/groom/formats/hair_strands_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    app::readHairStrands(bytes, "fuzz.hair");
  } catch (const app::InputError&) {
  }
  return 0;
}
