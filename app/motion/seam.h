// The seam of a loop: what is added to the end of a clip so that it leads into the clip's start.
//
// A crossfade of the clip's end with its beginning would mix two different phases of a walk that loops cleanly. Instead
// the difference between the first and the last pose is added to the end of the clip, grown from zero over the blend by
// a cubic whose end value and slope close both the gap in pose and the gap in velocity (the offset form that games call
// inertialization: Bollo 2018, GDC). Where there is no gap nothing changes. Rotations use rotation vectors in the
// joint's frame: q(t) exp(r(t)), r = log(q_last^-1 q_first) at the seam.
#pragma once

#include <array>

#include "app/motion/clip_sampling.h"
#include "app/motion/playback.h"

namespace app {

// A time of the clip and where the figure is put on the ground then.
struct PlacedMoment {
  ClipMoment moment;
  Rigid placement = Rigid::Identity();
};

// The moment `time` (s) of a round that begins over the origin; on a treadmill without its travel.
PlacedMoment placedMoment(const Skeleton& skeleton, const Clip& clip, const ClipLoop& loop, double time);

// Joint to parent, root joints to the ground of the round.
Rigid placedLocal(const Skeleton& skeleton, const Clip& clip, const PlacedMoment& placed, int joint);

// The moments that say how the clip starts and ends: three from the start of the next round, three to the end of this
// one, in order, whole frames and at least 1/60 s apart (fewer frames repeat): closer ones would show the capture's
// noise.
struct SeamMoments {
  std::array<PlacedMoment, 6> moments;
  double interval = 0;  // s between them
};
SeamMoments seamMoments(const Skeleton& skeleton, const Clip& clip, const ClipLoop& loop);

// The gap a joint has between the end of the clip and its start, in value and in velocity.
struct SeamGap {
  Vec3 shift, shift_rate;  // m, m/s, parent frame
  Vec3 turn, turn_rate;    // rad, rad/s, rotation vector in the joint frame
};
SeamGap seamGap(const Skeleton& skeleton, const Clip& clip, const SeamMoments& seam, int joint);

// What is added of a gap at `left` seconds before the end, of a blend of so many. The gap in velocity is closed over
// the last quarter of a second at most: what that adds on the way grows with the time that it takes.
struct SeamWeights {
  double value = 0, rate = 0;
  SeamWeights(double left, double blend);
};
void closeGap(const SeamGap& gap, const SeamWeights& weights, Rigid& local);

// The turn about y that brings the joints' orientations nearest to others: it maximizes sum tr(R_y to from^T), and
// stays defined when the body is upside down. `sum`: over the joints, to from^T.
double alignedTurn(const Eigen::Matrix3d& sum);

// Horizontal mean of the root joints.
Vec3 rootCentre(const Skeleton& skeleton, const Clip& clip, const ClipMoment& moment);

}  // namespace app
