// Fuzz target: strands from a .tfx file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/groom/formats/tfx_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    app::readTfx(bytes, "fuzz.tfx");
  } catch (const app::InputError&) {
  }
  return 0;
}
