// Fuzz target: a hair mesh OBJ, read and built.
#include "sim/mesh/hair_mesh.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/files/hair_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    sim::buildHairMesh(app::readHairMesh(text, "fuzz.obj"));
  } catch (const app::InputError&) {
  } catch (const sim::MeshError&) {
  }
  return 0;
}
