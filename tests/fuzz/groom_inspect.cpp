// Fuzz target: any groom, told by its content, inspected and mended.
#include "app/groom/inspect/groom_inspect.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "app/files/errors.h"
#include "app/groom/groom_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const app::HeadModel head{[](const Eigen::Vector3f& p) { return p.norm() - 0.09f; }, Eigen::Vector3f::Zero()};
  try {
    app::GroomHints hints;
    app::Groom groom = app::readGroom(bytes, "fuzz", &hints);
    const app::GroomInspection found = app::inspectGroom(groom, hints, &head);
    app::mendGroom(found.mends, &head, groom);
  } catch (const app::InputError&) {
  }
  return 0;
}
