// Fuzz target: curves from a .abc file, at two moments, and the moments' times.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/groom/formats/alembic_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    app::readAlembic(bytes, "fuzz.abc");
    app::readAlembic(bytes, "fuzz.abc", 1);
    app::alembicTimes(bytes, "fuzz.abc");
  } catch (const app::InputError&) {
  }
  return 0;
}
