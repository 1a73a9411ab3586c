// Fuzz target: a recording of a run.
#include "app/files/recording.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    app::readRecording(text, "fuzz.hmr");
  } catch (const app::InputError&) {
  }
  return 0;
}
