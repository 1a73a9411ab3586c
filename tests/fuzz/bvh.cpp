// Fuzz target: a BVH motion.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/motion/motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    app::readBvh(text, "fuzz.bvh");
  } catch (const app::InputError&) {
  }
  return 0;
}
