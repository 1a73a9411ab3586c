#pragma once
#include <array>

namespace app {

// A unit that grooms come in: as options name it, as messages do, and its length in metres.
struct LengthUnit {
  const char* name;
  const char* words;
  double metres;
};
inline constexpr std::array<LengthUnit, 5> kLengthUnits{{{"m", "metres", 1},
                                                         {"cm", "centimetres", 0.01},
                                                         {"mm", "millimetres", 0.001},
                                                         {"in", "inches", 0.0254},
                                                         {"ft", "feet", 0.3048}}};

}  // namespace app
