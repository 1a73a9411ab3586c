// What clip formats tell beside the strands: when the moments are, and in which unit.
#pragma once

#include <cstddef>
#include <vector>

namespace app {

// Moment n is sample n % offsets.size() of frame n / offsets.size().
struct ClipSettings {
  double fps = 24;                 // frames of the file a second
  double start = 0;                // s, of frame 0
  std::vector<double> offsets{0};  // s, of a frame's samples relative to it, rising; more than one for motion blur
  double meters_per_unit = 1;      // of the points and widths handed over
  int world_heads = 0;             // figures in whose world they are, said by worldMark (groom_file.h); 0: none

  double timeOf(std::size_t moment) const {
    return start + offsets[moment % offsets.size()] + static_cast<double>(moment / offsets.size()) / fps;
  }
};

}  // namespace app
