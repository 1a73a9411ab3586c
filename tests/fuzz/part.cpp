// Fuzz target: the mesh of a rigid body.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/figure/bone_mesh.h"
#include "app/files/errors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    app::readPart(text, "fuzz.obj");
  } catch (const app::InputError&) {
  }
  return 0;
}
