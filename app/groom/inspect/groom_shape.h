// The shape of a groom as a whole: where its roots lie as on a skull, and which way it hangs.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "app/groom/groom.h"

namespace app {

// A sphere through points, less those that lie far from it.
struct SphereFit {
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0;
  float spread = 0;    // median distance of the points from it, in radii
  float coverage = 0;  // least variance of the points' directions: 0 for a ring, 0.1 for a cap, 1/3 for all of it
};
SphereFit fitSphere(const std::vector<Eigen::Vector3f>& points);

inline constexpr std::size_t kMaxInspected = 2000;  // strands that are looked at
inline constexpr std::size_t kMinRoots = 20;        // of which a skull is told

struct StrandEnds {
  std::vector<std::size_t> strands;  // those looked at: finite, of at least two points, with a length, not astray
  std::vector<Eigen::Vector3f> first, last;
  std::size_t non_finite = 0, zero_length = 0, too_short = 0;  // of all strands; too_short: fewer than two points
  std::vector<std::size_t> astray;                             // of all strands that are none of these
};
// At most `most` strands are looked at, evenly spread; the counts are of all. `one_head`: a strand is astray whose
// points all lie outside of a box, or of which two in a row lie farther apart than three quarters of its largest side.
// The box holds all ends but the outermost 2 % of either side, and is grown by half of its largest side. Of several
// heads none is astray.
StrandEnds strandEnds(const Groom& groom, std::size_t most, bool one_head = true);

enum class StrandFault { kNone, kTooFewPoints, kNonFinite, kZeroLength };
// A strand shorter than 1e-6 of `size` has no length.
StrandFault strandFault(const Groom& groom, std::size_t strand, float size);
// The largest extent of all finite points.
float groomSize(const Groom& groom);

}  // namespace app
