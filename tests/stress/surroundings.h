// What happens around the hair in a case: the figure's clip, what is done to it beside, and bodies that are not its
// own.
#pragma once

#include <vector>

#include "sim/contact/colliders.h"
#include "tests/stress/random.h"
#include "tests/stress/stage.h"

namespace stress {

class Surroundings {
 public:
  // The stage stands at its clip's first pose. `distances`: the bodies are signed distances, the stage's own parts and
  // a grid of any body that is added, in place of the ellipsoids.
  Surroundings(const StressCase& one, bool distances, Stage& stage, Random& random);

  // Moves everything on by dt (s).
  void move(double dt);
  // Everything stays where it is from now on.
  void stop();
  // Time goes by and nothing moves.
  void pass(double dt) { time_ += dt; }

  const std::vector<sim::Vec3>& roots() const { return roots_; }
  const std::vector<sim::Ellipsoid>& ellipsoids() const { return ellipsoids_; }
  // None where the ellipsoids act.
  const std::vector<sim::BodySdf>& parts() const { return parts_; }
  // Scalp frame to world, disturbance included.
  const Eigen::Isometry3d& head() const { return head_; }
  // Of the body that the case adds, among those in use; -1 while it is not there.
  int intruderIndex() const;
  // The hair is to be carried along from where the head was before the last move.
  bool carries() const { return carries_; }
  // A body has appeared within the hair, or hair has been carried somewhere else, during the last move.
  bool intrudes() const { return intrudes_; }
  double time() const { return time_; }

 private:
  const StressCase& one_;
  const bool distances_;
  Stage& stage_;
  Random& random_;
  double time_ = 0;
  int beat_ = 0;                                             // half seconds, or quarters, begun so far
  Eigen::Isometry3d whole_ = Eigen::Isometry3d::Identity();  // of the figure
  Eigen::Isometry3d nod_ = Eigen::Isometry3d::Identity();    // of the head alone
  double rise_ = 0;                                          // m, of the body alone
  bool carries_ = false, intrudes_ = false;
  std::vector<sim::Vec3> roots_;
  std::vector<sim::Ellipsoid> ellipsoids_, before_;
  std::vector<sim::BodySdf> parts_, parts_before_;
  std::vector<float> intruder_distances_;  // of the body that is added, about its own centre
  sim::DistanceGrid intruder_grid_;
  Eigen::Isometry3d head_ = Eigen::Isometry3d::Identity();
  double arm_height_ = 0;  // m, in the head's frame

  void playClip(double dt);
  void disturb();
  void pose(double dt);
  Eigen::Isometry3d placeOf(int joint) const;
  bool intruder(sim::Ellipsoid& body) const;
  void addIntruder();
  void sampleIntruder(const sim::Ellipsoid& body);
};

}  // namespace stress
