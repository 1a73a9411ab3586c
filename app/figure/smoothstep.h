// The cubic step that figures and styles are shaped with.
#pragma once

#include <algorithm>

namespace app {

// 0 up to a, 1 from b on, with a continuous slope between; a != b.
inline double smoothstep(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace app
