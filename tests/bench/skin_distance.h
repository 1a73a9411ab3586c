// Distance to the posed skin itself, triangle by triangle: what colliders are measured against.
#pragma once

#include <vector>

#include "app/figure/character.h"

namespace bench {

class SkinDistance {
 public:
  // The skin of a pose, blended as it is drawn.
  SkinDistance(const app::Character& character, const app::Pose& pose);
  // m, signed (negative inside, by the winding number); within `reach` exact, beyond it `reach`.
  double at(const app::Vec3& p, double reach) const;

 private:
  struct Face {
    app::Vec3 a, b, c, middle;
    double radius;
  };
  std::vector<Face> faces_;
};

}  // namespace bench
