#include "app/groom/inspect/head_seat.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "app/files/median.h"

namespace app {

using Eigen::Vector3f;

namespace {

constexpr float kShapes = 0.0035f;   // m, median that two heads of one size are apart
constexpr float kMuchCloser = 0.4f;  // of what is left without the scale
constexpr float kStep = 1.025f, kLeast = 0.1f;
constexpr int kSteps = 20, kFewRounds = 10;

float offAtScale(const HeadModel& head, std::vector<Vector3f> roots, const Vector3f& center, float scale) {
  for (Vector3f& root : roots) root *= scale;
  const Vector3f move = moveToHead(head, roots, scale * center);
  for (Vector3f& root : roots) root += move;
  return offHead(head, roots);
}

// Enough to tell a turn by.
std::vector<Vector3f> someOf(const std::vector<Vector3f>& roots) {
  constexpr std::size_t kEnough = 100;
  std::vector<Vector3f> some;
  for (std::size_t n = 0; n < roots.size(); n += std::max<std::size_t>(roots.size() / kEnough, 1))
    some.push_back(roots[n]);
  return some;
}

}  // namespace

float offHead(const HeadModel& head, const std::vector<Vector3f>& roots) {
  std::vector<float> off;
  for (const Vector3f& root : roots) off.push_back(std::abs(head.distance(root)));
  return median(std::move(off));
}

Vector3f moveToHead(const HeadModel& head, const std::vector<Vector3f>& roots, const Vector3f& center, int rounds) {
  Vector3f move = head.center - center;
  const std::size_t stride = std::max<std::size_t>(roots.size() / 200, 1);
  for (int round = 0; round < rounds; ++round) {
    Vector3f step = Vector3f::Zero();
    Eigen::Matrix3f normals = 1e-3f * Eigen::Matrix3f::Identity();
    for (std::size_t n = 0; n < roots.size(); n += stride) {
      const Vector3f at = roots[n] + move;
      const float here = head.distance(at);
      Vector3f slope;
      for (int axis = 0; axis < 3; ++axis)
        slope[axis] = (head.distance(at + 1e-3f * Vector3f::Unit(axis)) - here) / 1e-3f;
      step += slope * std::clamp(here, -0.03f, 0.03f);
      normals += slope * slope.transpose();
    }
    move -= normals.inverse() * step;
  }
  return move;
}

float offHeadTurned(const HeadModel& head, std::vector<Vector3f> roots, const Vector3f& center,
                    const Eigen::Matrix3f& matrix) {
  for (Vector3f& root : roots) root = matrix * root;
  const Vector3f move = moveToHead(head, roots, matrix * center, kFewRounds);
  for (Vector3f& root : roots) root += move;
  return offHead(head, roots);
}

std::array<float, kUps.size()> upsByHang(const Vector3f& cap, const Vector3f& hang, const Eigen::Matrix3f& told) {
  constexpr float kUpper = 0.15f;  // of the mean direction's length
  const Vector3f ours = cap.dot(hang) > 0.5f * cap.norm() * hang.norm() ? cap : Vector3f(cap - 1.5f * hang);
  std::array<float, kUps.size()> scores{};
  for (std::size_t n = 0; n < scores.size(); ++n) {
    const Vector3f up = told * axesOfUp(kUps[n])->row(1).transpose();
    scores[n] = up.dot(cap) > kUpper * cap.norm() ? up.dot(ours) : -INFINITY;
  }
  return scores;
}

std::array<float, kUps.size()> upsOnHead(const HeadModel& head, const std::vector<Vector3f>& roots,
                                         const Vector3f& center, const Eigen::Matrix3f& told) {
  std::array<float, kUps.size()> off{};
  const std::vector<Vector3f> some = someOf(roots);
  for (std::size_t n = 0; n < off.size(); ++n) {
    off[n] = INFINITY;
    for (const double degrees : {0.0, 90.0, 180.0, -90.0}) {
      const Eigen::Matrix3f matrix = turnedAbout(degrees) * *axesOfUp(kUps[n]) * told.transpose();
      off[n] = std::min(off[n], offHeadTurned(head, some, center, matrix));
    }
  }
  return off;
}

bool farBetter(float off, float other) {
  return off < kMuchCloser * other && other > kShapes;
}

bool standsInWorld(const HeadModel& head, const Vector3f& center) {
  constexpr float kUp = 0.15f, kAside = 0.3f;  // m
  if (!head.standing) return false;
  const Vector3f away = center - *head.standing;
  return std::abs(away.y()) < kUp && std::hypot(away.x(), away.z()) < kAside;
}

std::optional<std::size_t> standingUp(const HeadModel& head, const Vector3f& center, const Eigen::Matrix3f& told) {
  std::optional<std::size_t> found;
  for (std::size_t n = 0; n < kUps.size(); ++n) {
    if (!standsInWorld(head, *axesOfUp(kUps[n]) * told.transpose() * center)) continue;
    if (found) return {};
    found = n;
  }
  return found;
}

double turnOnHead(const HeadModel& head, const std::vector<Vector3f>& roots, const Vector3f& center) {
  const std::vector<Vector3f> some = someOf(roots);
  const auto off = [&](double degrees) { return offHeadTurned(head, some, center, turnedAbout(degrees)); };
  double best = 0;
  float least = off(0);
  for (const double degrees : {180.0, 90.0, -90.0}) {
    const float here = off(degrees);
    if (farBetter(here, least)) best = degrees, least = here;
  }
  return best;
}

float scaleToHead(const HeadModel& head, const std::vector<Vector3f>& roots, const Vector3f& center) {
  const float unscaled = offAtScale(head, roots, center, 1);
  if (unscaled <= kShapes) return 1;
  float best = 1, least = unscaled;
  for (int step = -kSteps; step <= kSteps; ++step) {
    const float scale = std::pow(kStep, static_cast<float>(step)), off = offAtScale(head, roots, center, scale);
    if (off < least) best = scale, least = off;
  }
  return least < kMuchCloser * unscaled && std::abs(best - 1) >= kLeast ? best : 1;
}

}  // namespace app
