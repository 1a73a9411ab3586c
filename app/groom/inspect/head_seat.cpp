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
constexpr int kSteps = 20;

float offAtScale(const HeadModel& head, std::vector<Vector3f> roots, const Vector3f& center, float scale) {
  for (Vector3f& root : roots) root *= scale;
  const Vector3f move = moveToHead(head, roots, scale * center);
  for (Vector3f& root : roots) root += move;
  return offHead(head, roots);
}

}  // namespace

float offHead(const HeadModel& head, const std::vector<Vector3f>& roots) {
  std::vector<float> off;
  for (const Vector3f& root : roots) off.push_back(std::abs(head.distance(root)));
  return median(std::move(off));
}

Vector3f moveToHead(const HeadModel& head, const std::vector<Vector3f>& roots, const Vector3f& center) {
  Vector3f move = head.center - center;
  const std::size_t stride = std::max<std::size_t>(roots.size() / 200, 1);
  for (int round = 0; round < 20; ++round) {
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
