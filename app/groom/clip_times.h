// When the moments of an exported clip are: what Alembic and USD files tell beside the strands.
#pragma once

#include <cstddef>
#include <vector>

namespace app {

// Moment n is sample n % offsets.size() of frame n / offsets.size().
struct ClipTimes {
  double fps = 24;                 // frames of the file a second
  double start = 0;                // s, of frame 0
  std::vector<double> offsets{0};  // s, of a frame's samples relative to it, rising; more than one for motion blur

  double of(std::size_t moment) const {
    return start + offsets[moment % offsets.size()] + static_cast<double>(moment / offsets.size()) / fps;
  }
};

}  // namespace app
