// What clip formats tell beside the strands: when the moments are, and in which unit.
#pragma once

#include <cstddef>
#include <vector>

namespace app {

// Moment n is sample n % offsets.size() of frame first + every * (n / offsets.size()).
struct ClipSettings {
  double fps = 24;                 // frames a second; frame 0 is at 0 s
  long first = 0;                  // number of the first frame that is written
  std::vector<double> offsets{0};  // s, of a frame's samples relative to it, rising; more than one for motion blur
  double meters_per_unit = 1;      // of the points and widths handed over
  int world_heads = 0;             // figures in whose world they are, said by worldMark (groom_file.h); 0: none
  long every = 1;                  // of the frames, every nth is written

  // The frame's number, and how far into it the moment is.
  double frameOf(std::size_t moment) const {
    const auto number = first + every * static_cast<long>(moment / offsets.size());
    return static_cast<double>(number) + offsets[moment % offsets.size()] * fps;
  }
  double timeOf(std::size_t moment) const { return frameOf(moment) / fps; }  // s
};

}  // namespace app
