// What a file tells about its strands beside them, and what a person says of it.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace app {

struct GroomHints {
  std::optional<double> meters_per_unit;
  std::optional<char> up;  // 'Y' or 'Z'
  // Given by a person, and not guessed: meters_per_unit, the file's axes into ours, and the turn about y after it.
  bool unit_given = false;
  std::optional<Eigen::Matrix3f> axes, turn;
  int world_heads = 0;  // of an export of this program: y up, each head where its figure holds it; 0: no such file
  int hidden = 0;       // curve objects that the file hides, and that are left out
};

}  // namespace app
