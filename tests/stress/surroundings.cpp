#include "tests/stress/surroundings.h"

#include <cmath>
#include <numbers>

namespace stress {
namespace {

constexpr double kHalf = 0.5, kQuarter = 0.25;  // s
constexpr double kShakeAmplitude = 0.2;         // m
constexpr double kNodAngle = 1;                 // rad
const sim::Vec3 kArmRadii(0.3, 0.035, 0.035);   // m
constexpr double kArmReach = 0.6;               // m either side of the head
constexpr double kAppears = 0.2;                // s after the start

Eigen::Isometry3d rotationAbout(const sim::Vec3& pivot, double angle, const sim::Vec3& axis) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn = Eigen::Translation3d(pivot) * Eigen::AngleAxisd(angle, axis) * Eigen::Translation3d(-pivot);
  return turn;
}

double interval(Upset upset) {
  return upset == Upset::kBodyRise ? kQuarter : kHalf;
}

}  // namespace

Surroundings::Surroundings(const StressCase& one, Stage& stage, Random& random)
    : one_(one), stage_(stage), random_(random) {
  pose(0);
}

void Surroundings::move(double dt) {
  before_ = ellipsoids_;
  carries_ = intrudes_ = false;
  const double end = time_ + dt;
  playClip(dt);
  time_ = end;
  disturb();
  pose(dt);
}

void Surroundings::stop() {
  for (sim::Ellipsoid& e : ellipsoids_) e.velocity = e.angular_velocity = sim::Vec3::Zero();
}

void Surroundings::playClip(double dt) {
  app::Playback& playback = stage_.actor.playback;
  const double length = stage_.actor.playedClip().duration();
  playback.paused = true;
  if (one_.play == Play::kForward || one_.play == Play::kBackward) {
    const double direction = one_.play == Play::kForward ? 1 : -1;
    playback.time = std::fmod(playback.time + direction * one_.speed * dt, length);
    if (playback.time < 0) playback.time += length;
  }
  const bool jumps = one_.play == Play::kJumps || one_.play == Play::kCarryJumps;
  if (jumps && std::floor((time_ + dt) / kQuarter) > std::floor(time_ / kQuarter)) {
    playback.time = random_(0, length);
    carries_ = intrudes_ = one_.play == Play::kCarryJumps;
  } else if (jumps) {
    playback.time = std::fmod(playback.time + dt, length);
  }
  if (one_.play != Play::kStill) app::moveActor(dt, stage_.actor);
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

void Surroundings::pose(double dt) {
  const app::Character& character = stage_.actor.body->character;
  const Eigen::Isometry3d head = whole_ * nod_;
  head_ = head * app::scalpToWorld(character, stage_.actor.pose);
  roots_ = stage_.actor.roots;
  for (sim::Vec3& root : roots_) root = head * root;
  ellipsoids_ = stage_.actor.ellipsoids;
  for (std::size_t k = 0; k < ellipsoids_.size(); ++k) {
    sim::Ellipsoid& e = ellipsoids_[k];
    const bool of_head = character.ellipsoids[k].joint == character.head_joint;
    const Eigen::Isometry3d place = of_head ? head : Eigen::Isometry3d(Eigen::Translation3d(0, rise_, 0) * whole_);
    e.center = place * e.center;
    e.rotation = Eigen::Quaterniond(place.linear()) * e.rotation;
  }
  addIntruder();
  for (std::size_t k = 0; k < ellipsoids_.size(); ++k) {
    sim::Ellipsoid& e = ellipsoids_[k];
    e.velocity = e.angular_velocity = sim::Vec3::Zero();
    if (dt <= 0 || k >= before_.size()) continue;
    e.velocity = (e.center - before_[k].center) / dt;
    const Eigen::AngleAxisd turn(e.rotation * before_[k].rotation.conjugate());
    e.angular_velocity = turn.angle() * turn.axis() / dt;
  }
}

void Surroundings::addIntruder() {
  sim::Ellipsoid body;
  switch (one_.upset) {
    case Upset::kArm: {
      // A saw: from one side to the other and back, across the hair behind the neck, along the figure's x axis.
      const double way = std::fmod(one_.upset_size * time_, 4 * kArmReach);
      const double at = way < 2 * kArmReach ? way - kArmReach : 3 * kArmReach - way;
      body.center = head_ * sim::Vec3(0, -0.12, at);
      body.rotation = Eigen::Quaterniond(head_.linear());
      body.radii = kArmRadii;
      break;
    }
    case Upset::kSwitchOn:
      if (time_ < kAppears) return;
      body.center = head_ * sim::Vec3(0.02, -0.02, -0.1);
      body.radii = sim::Vec3::Constant(one_.upset_size);
      break;
    case Upset::kBury:
      if (time_ < kAppears) return;
      body.center = head_ * sim::Vec3(0, 0.02, 0);
      body.radii = sim::Vec3(0.13, 0.15, 0.14);
      break;
    default:
      return;
  }
  // It was not there a step ago.
  intrudes_ = intrudes_ || before_.size() == ellipsoids_.size();
  ellipsoids_.push_back(body);
}

}  // namespace stress
