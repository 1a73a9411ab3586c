// Scalar fields over the scalp, painted as grey pictures.
//
// A picture is the head unrolled: its middle column is the front, its sides the back, its left half the figure's right
// side; its top row is the crown, the row half-way down lies level with the tops of the ears. White stands for the
// parameter's own value, black for its least.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/mesh/hair_mesh.h"

namespace app {

struct FieldMap {
  int width = 0, height = 0;
  std::vector<float> value;  // 0 to 1, top row first

  // In a direction from the head's middle (need not be unit), bilinear; the left and right sides meet.
  double at(const sim::Vec3& direction) const;
};

// The luminance of a PNG. Throws InputError.
FieldMap readFieldMap(const std::string& file);

// The pictures that a character is painted with; empty: none.
struct FieldFiles {
  std::string stiffness, length, density;
  bool operator==(const FieldFiles&) const = default;
};

// Gives the field of a name another picture. Returns what is wrong with the name, empty when fine.
std::string setMap(std::string_view name, const std::string& file, FieldFiles& maps);

}  // namespace app
