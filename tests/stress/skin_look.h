// A case's drawn strands against its drawn skin (tests/skin), where Embree is installed.
#pragma once

#include <memory>
#include <span>

#include "tests/stress/stage.h"

namespace stress {

// Points of strands, over the looks so far.
struct SkinSeen {
  long points = 0, under = 0;  // all; those more than kUnder below the skin
  double deepest = 0;          // m

  double share() const { return points > 0 ? static_cast<double>(under) / static_cast<double>(points) : 0; }
};
inline constexpr double kUnder = 1e-3;  // m

class SkinLook {
 public:
  explicit SkinLook(const Stage& stage);
  ~SkinLook();

  // The figure as it stands on the stage, and hair of these vertices (m, world).
  void look(const app::Actor& actor, std::span<const sim::Vec3> hair, SkinSeen& seen);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stress
