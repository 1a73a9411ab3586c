// Radiance pictures (.hdr, .pic): light of any brightness.
#pragma once

#include <string>
#include <vector>

namespace app {

// Linear RGB in the file's own unit, 0 or more; top row first, width * height * 3.
struct RadiancePicture {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

// Reads a picture in RGBE, its rows packed or not. Source of the format: Ward 1991, Real Pixels (Graphics Gems II). Throws
// InputError when it is missing, no such picture, broken off, or larger than 8,192 pixels a side. Every value that the
// format can hold is a finite number.
RadiancePicture readRadiance(const std::string& file);

}  // namespace app
