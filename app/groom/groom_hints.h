// What a file tells about its strands beside them.
#pragma once

#include <optional>

namespace app {

struct GroomHints {
  std::optional<double> meters_per_unit;
  std::optional<char> up;  // 'Y' or 'Z'
  int world_heads = 0;     // of an export of this program: y up, each head where its figure holds it; 0: no such file
};

}  // namespace app
