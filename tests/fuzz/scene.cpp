// Fuzz target: a scene, which must be written as text that reads back.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/files/scene_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const app::Scene scene = app::readScene(text, "fuzz.json");
    app::readScene(app::writeScene(scene), "written.json");
  } catch (const app::InputError&) {
  }
  return 0;
}
