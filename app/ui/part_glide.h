// The way of the figure's part of the window from one place to another: panels that open and close do not make it jump.
#pragma once

#include <algorithm>
#include <utility>

#include "app/scene/view/camera.h"

namespace app {

inline constexpr double kPartGlide = 0.2;  // s

class PartGlide {
 public:
  // Where it is at a moment (s), on its way to a goal that may change. With `at_once` it is there.
  PicturePart to(const PicturePart& goal, double moment, bool at_once) {
    const double passed = moment - std::exchange(moment_, moment);
    if (at_once || goal != goal_) {
      from_ = at_once ? goal : now_;
      goal_ = goal, elapsed_ = at_once ? kPartGlide : 0;
    } else {
      elapsed_ += passed;
    }
    const double t = std::clamp(elapsed_ / kPartGlide, 0.0, 1.0), share = t * t * (3 - 2 * t);
    const auto between = [&](double PicturePart::*side) { return from_.*side + share * (goal_.*side - from_.*side); };
    now_ = t < 1 ? PicturePart{between(&PicturePart::left), between(&PicturePart::right), between(&PicturePart::top),
                               between(&PicturePart::bottom)}
                 : goal_;
    return now_;
  }
  // It stays where it is; the time counts for nothing.
  PicturePart stay(double moment) {
    moment_ = moment;
    return now_;
  }
  bool arrived() const { return elapsed_ >= kPartGlide; }

 private:
  PicturePart from_, now_, goal_;
  double moment_ = 0, elapsed_ = kPartGlide;  // s
};

}  // namespace app
