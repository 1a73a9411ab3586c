// Fuzz target: a preset, applied to all three tables.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/files/presets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    sim::SimParams sim;
    app::SceneLook scene;
    app::CharacterLook look;
    std::array<app::CharacterLook*, 1> looks{&look};
    app::applyPreset(text, "fuzz.json", {&sim, &scene, looks});
  } catch (const app::InputError&) {
  }
  return 0;
}
