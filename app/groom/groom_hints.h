// What a file tells about its strands beside them.
#pragma once

#include <optional>

namespace app {

struct GroomHints {
  std::optional<double> meters_per_unit;
  std::optional<char> up;  // 'Y' or 'Z'
};

}  // namespace app
