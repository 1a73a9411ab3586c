#include "tests/stress/surroundings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stress {
namespace {

constexpr double kHalf = 0.5, kQuarter = 0.25;  // s
constexpr double kShakeAmplitude = 0.2;         // m
constexpr double kNodAngle = 1;                 // rad
const sim::Vec3 kArmRadii(0.3, 0.035, 0.035);   // m
constexpr double kArmHeight = -0.12;    // m in the head's frame, or higher, where the hair does not reach so low
constexpr double kArmReach = 0.6;       // m either side of the head
constexpr double kAppears = 0.2;        // s after the start
constexpr double kGridSpacing = 0.005;  // m, of an added body's distances; the figure's own take 7 mm

Eigen::Isometry3d rotationAbout(const sim::Vec3& pivot, double angle, const sim::Vec3& axis) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn = Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle, axis) * Eigen::Translation3d(-pivot);
  return turn;
}

double interval(Upset upset) {
  return upset == Upset::kBodyRise ? kQuarter : kHalf;
}

void carryBody(const Eigen::Isometry3d& place, sim::Ellipsoid& e) {
  e.center = place * e.center;
  e.rotation = Eigen::Quaterniond(place.linear()) * e.rotation;
}

// The motion that brought a body from its pose before to its present one; none where it is new.
void setMotion(const sim::Ellipsoid* before, double dt, sim::Ellipsoid& e) {
  e.velocity = e.angular_velocity = sim::Vec3::Zero();
  if (dt <= 0 || !before) return;
  e.velocity = (e.center - before->center) / dt;
  const Eigen::AngleAxisd turn(e.rotation * before->rotation.conjugate());
  e.angular_velocity = turn.angle() * turn.axis() / dt;
}

}  // namespace

Surroundings::Surroundings(const StressCase& one, bool distances, Stage& stage, Random& random)
    : one_(one), distances_(distances), stage_(stage), random_(random) {
  head_ = app::scalpToWorld(stage.actor.body->character, stage.actor.pose);
  const Eigen::Isometry3d to_head = head_.inverse();
  double lowest = INFINITY;
  for (const sim::Vec3& p : stage.settled.positions) lowest = std::min(lowest, (to_head * p).y());
  arm_height_ = std::max(kArmHeight, lowest + kArmRadii.y());
  pose(0);
}

void Surroundings::move(double dt) {
  before_ = ellipsoids_;
  parts_before_ = parts_;
  carries_ = intrudes_ = false;
  const double end = time_ + dt;
  playClip(dt);
  time_ = end;
  disturb();
  pose(dt);
}

void Surroundings::stop() {
  for (sim::Ellipsoid& e : ellipsoids_) setMotion(nullptr, 0, e);
  for (sim::BodySdf& part : parts_) setMotion(nullptr, 0, part.bounds);
}

void Surroundings::playClip(double dt) {
  app::Playback& playback = stage_.actor.playback;
  const double length = stage_.actor.playedClip().duration();
  playback.paused = one_.play != Play::kForward;
  playback.speed = one_.speed;
  if (one_.play == Play::kBackward) {
    playback.time = std::fmod(playback.time - one_.speed * dt, length);
    if (playback.time < 0) playback.time += length;
  }
  const bool jumps = one_.play == Play::kJumps || one_.play == Play::kCarryJumps;
  if (jumps && std::floor((time_ + dt) / kQuarter) > std::floor(time_ / kQuarter)) {
    playback.time = random_(0, length);
    carries_ = intrudes_ = one_.play == Play::kCarryJumps;
    // As in the window, bodies that are carried along with the hair have not moved.
    if (carries_) before_.clear(), parts_before_.clear();
  } else if (jumps) {
    playback.time = std::fmod(playback.time + dt, length);
  }
  const sim::Vec3 jumped = stage_.actor.jumped;
  if (one_.play != Play::kStill) app::moveActor(dt, stage_.actor);
  if (stage_.actor.jumped == jumped) return;
  // The whole figure has jumped, at a seam: hair and bodies come along.
  carries_ = intrudes_ = true;
  before_.clear(), parts_before_.clear();
}

// The pose of the disturbance at time_.
void Surroundings::disturb() {
  const sim::Vec3 pivot = app::scalpToWorld(stage_.actor.body->character, stage_.actor.pose).translation();
  const int beat = static_cast<int>(std::floor(time_ / interval(one_.upset)));
  const bool struck = beat > beat_;
  beat_ = beat;
  const double phase = 2 * std::numbers::pi * one_.upset_size * time_;
  switch (one_.upset) {
    case Upset::kTurn:
      if (struck) nod_ = rotationAbout(pivot, std::numbers::pi, sim::Vec3::UnitY()) * nod_;
      break;
    case Upset::kTeleport:
      if (struck) whole_ = Eigen::Translation3d(one_.upset_size * random_.direction()) * whole_;
      break;
    case Upset::kSpin:
      whole_ = rotationAbout(pivot, one_.upset_size * time_, sim::Vec3::UnitY());
      break;
    case Upset::kShake:
      whole_ = Eigen::Translation3d(kShakeAmplitude *
                                    sim::Vec3(std::sin(phase), std::sin(0.7 * phase), std::sin(1.3 * phase))) *
               Eigen::Isometry3d::Identity();
      break;
    case Upset::kNod:
      nod_ = rotationAbout(pivot, kNodAngle * std::sin(phase), sim::Vec3(1, 0.5, 0.3).normalized());
      break;
    case Upset::kBodyRise:
      rise_ = beat % 2 == 1 ? one_.upset_size : 0;
      intrudes_ = intrudes_ || struck;
      break;
    default:
      break;
  }
}

// Where the disturbance carries what hangs on a joint: head and body go their own ways.
Eigen::Isometry3d Surroundings::placeOf(int joint) const {
  if (joint == stage_.actor.body->character.head_joint) return whole_ * nod_;
  return Eigen::Isometry3d(Eigen::Translation3d(0, rise_, 0) * whole_);
}

void Surroundings::pose(double dt) {
  const app::Character& character = stage_.actor.body->character;
  const Eigen::Isometry3d head = whole_ * nod_;
  head_ = head * app::scalpToWorld(character, stage_.actor.pose);
  roots_ = stage_.actor.roots;
  for (sim::Vec3& root : roots_) root = head * root;
  ellipsoids_ = stage_.actor.ellipsoids;
  for (std::size_t k = 0; k < ellipsoids_.size(); ++k)
    carryBody(placeOf(character.ellipsoids[k].joint), ellipsoids_[k]);
  if (distances_) {
    const std::vector<app::PartDistance>& parts = partsOf(stage_);
    app::posePartDistances(parts, stage_.actor.pose, stage_.actor.pose, 0, parts_);
    for (std::size_t k = 0; k < parts.size(); ++k) carryBody(placeOf(parts[k].joint), parts_[k].bounds);
  }
  addIntruder();
  for (std::size_t k = 0; k < ellipsoids_.size(); ++k)
    setMotion(k < before_.size() ? &before_[k] : nullptr, dt, ellipsoids_[k]);
  for (std::size_t k = 0; k < parts_.size(); ++k)
    setMotion(k < parts_before_.size() ? &parts_before_[k].bounds : nullptr, dt, parts_[k].bounds);
}

// The body that the case adds to the figure's, at this time; false when there is none.
bool Surroundings::intruder(sim::Ellipsoid& body) const {
  switch (one_.upset) {
    case Upset::kArm: {
      // A saw: from one side to the other and back, across the hair behind the neck, along the figure's x axis.
      const double way = std::fmod(one_.upset_size * time_, 4 * kArmReach);
      const double at = way < 2 * kArmReach ? way - kArmReach : 3 * kArmReach - way;
      body.center = head_ * sim::Vec3(0, arm_height_, at);
      body.rotation = Eigen::Quaterniond(head_.linear());
      body.radii = kArmRadii;
      return true;
    }
    case Upset::kSwitchOn:
      if (time_ < kAppears) return false;
      body.center = head_ * sim::Vec3(0.02, -0.02, -0.1);
      body.radii = sim::Vec3::Constant(one_.upset_size);
      return true;
    case Upset::kBury:
      if (time_ < kAppears) return false;
      body.center = head_ * sim::Vec3(0, 0.02, 0);
      body.radii = sim::Vec3(0.13, 0.15, 0.14);
      return true;
    default:
      return false;
  }
}

int Surroundings::intruderIndex() const {
  if (ellipsoids_.size() == stage_.actor.ellipsoids.size()) return -1;
  return static_cast<int>(distances_ ? parts_.size() : ellipsoids_.size()) - 1;
}

void Surroundings::addIntruder() {
  sim::Ellipsoid body;
  if (!intruder(body)) return;
  // It was not there a step ago.
  intrudes_ = intrudes_ || before_.size() == ellipsoids_.size();
  ellipsoids_.push_back(body);
  if (!distances_) return;
  // Parts act in place of all ellipsoids: what is added must be one of them.
  if (intruder_distances_.empty()) sampleIntruder(body);
  sim::BodySdf part{body, intruder_grid_};
  // A ball around the box, as the figure's own parts have.
  part.bounds.radii = sim::Vec3::Constant(intruder_grid_.low.norm());
  parts_.push_back(part);
}

// Signed distances of the ellipsoid, two nodes farther than its surface.
void Surroundings::sampleIntruder(const sim::Ellipsoid& body) {
  sim::Ellipsoid own;
  own.radii = body.radii;
  sim::DistanceGrid& grid = intruder_grid_;
  grid.spacing = kGridSpacing;
  for (int axis = 0; axis < 3; ++axis) {
    const int half = static_cast<int>(std::ceil(body.radii[axis] / kGridSpacing)) + 2;
    grid.nodes[axis] = 2 * half + 1;
    grid.low[axis] = -half * kGridSpacing;
  }
  for (int k = 0; k < grid.nodes[2]; ++k) {
    for (int j = 0; j < grid.nodes[1]; ++j) {
      for (int i = 0; i < grid.nodes[0]; ++i) {
        const sim::Vec3 p = grid.low + kGridSpacing * sim::Vec3(i, j, k);
        intruder_distances_.push_back(static_cast<float>(sim::closestPoint(own, p).distance));
      }
    }
  }
  grid.values = intruder_distances_;
  grid.deepest = body.radii.minCoeff();
}

}  // namespace stress
