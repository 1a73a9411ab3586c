// How rough the hair's motion is in time, against the steps that it is taken in.
#pragma once

#include <span>
#include <vector>

#include "sim/hair_mesh.h"
#include "sim/hair_state.h"

namespace sim {

// The change of velocity over a step against that over the step before it: with d_n = v_n - v_(n-1), mass-weighted over
// the free vertices, |d_n - d_(n-1)| / |d_n|. Near 0 where acceleration lasts, 1 and more where it comes and goes from
// step to step. A one-step method of first order errs in a step by about half this share of d_n: solving for d_n to
// much less than that buys nothing.
class MotionRoughness {
 public:
  explicit MotionRoughness(const HairMesh& mesh);

  // The roughness at the start of a step, from the velocities (m/s) there; 0 until three steps have begun.
  double at(const HairMesh& mesh, std::span<const Vec3> velocities);

 private:
  std::vector<Vec3> velocity_, change_;  // of the last step's start
  int steps_ = 0;
};

// The factor on a solve's tolerance for a motion of this roughness: 1 where it is smooth, up to kMostSlack.
inline constexpr double kSmooth = 0.3, kMostSlack = 10;
double toleranceFactor(double roughness, double slack);

}  // namespace sim
