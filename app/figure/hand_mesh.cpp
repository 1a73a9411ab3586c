#include "app/figure/hand_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "app/figure/fine_mesh.h"
#include "app/figure/smoothstep.h"

namespace app {

namespace {

using ArmShape = BodyField::ArmShape;
using Eigen::Vector3f;

constexpr int kHandHalvings = 2;                    // of the mesh's edges
constexpr int kHandRounds = 16;                     // see drawOntoHands
constexpr double kPastPalm = 3;                     // palm lengths from the wrist, beyond the fingertips
constexpr double kPaddle = 0.04, kParted = 0.0025;  // m, blends of fingers
constexpr double kMittenSkin = 0.007;               // m off the mitten that is still its skin
constexpr double kHandStep = 3e-4;                  // m

// `blend`: m over which fingers run into one another.
double handValue(const ArmShape& arm, const Vec3& p, double blend) {
  double digits = arm.digits[0].value(p);
  for (std::size_t k = 1; k < arm.digits.size(); ++k) digits = smoothMin(digits, arm.digits[k].value(p), blend);
  return smoothMin(smoothMin(arm.palm.value(p), digits, 0.024), arm.thumb.value(p), 0.014);
}

// Of the value `at` p.
Vec3 handSlope(const ArmShape& arm, const Vec3& p, double at, double blend) {
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis)
    slope[axis] = (handValue(arm, p + kHandStep * Vec3::Unit(axis), blend) - at) / kHandStep;
  return slope;
}

// 0 at the wrist and elsewhere, 1 from the middle of the palm on.
double handShare(const ArmShape& arm, const Vec3& p) {
  const double share = arm.present ? smoothstep(0.15, 0.6, arm.palm.along(p)) : 0;
  return share > 0 && arm.palm.along(p) < kPastPalm && mittenValue(arm, p) < kMittenSkin ? share : 0;
}

const ArmShape* armOf(const BodyField& body, const Vec3& p) {
  for (const ArmShape& arm : body.arms) {
    if (handShare(arm, p) > 0) return &arm;
  }
  return nullptr;
}

// To the hand's surface, as far as `share` says.
Vec3 onHand(const ArmShape& arm, const Vec3& from, double share, double blend) {
  const double off = handValue(arm, from, blend);
  const Vec3 out = handSlope(arm, from, off, blend);
  return from - share * off / std::max(out.squaredNorm(), 0.1) * out;
}

struct HandVertex {
  std::size_t vertex;
  const ArmShape* arm;
  double share;
  std::vector<std::size_t> beside;
};

std::vector<HandVertex> handVertices(const SkinnedMesh& mesh, const BodyField& body) {
  std::vector<HandVertex> hands;
  std::vector<int> number(mesh.positions.size(), -1);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3 p = mesh.positions[v].cast<double>();
    const ArmShape* arm = armOf(body, p);
    if (!arm) continue;
    number[v] = static_cast<int>(hands.size());
    hands.push_back({v, arm, handShare(*arm, p), {}});
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t a = mesh.triangles[t], b = mesh.triangles[t % 3 == 2 ? t - 2 : t + 1];
    if (number[a] >= 0) hands[static_cast<std::size_t>(number[a])].beside.push_back(b);
  }
  return hands;
}

// Round after round vertices are evened out and brought to the surface of a paddle from which fingers part: fingertips
// stand where the mitten has few vertices.
void drawOntoHands(std::span<const HandVertex> hands, SkinnedMesh& mesh) {
  std::vector<Vector3f> moved = mesh.positions;
  for (int round = 0; round <= kHandRounds; ++round) {
    const double left = 1 - static_cast<double>(round) / kHandRounds, blend = kParted + (kPaddle - kParted) * left;
    for (const HandVertex& one : hands) {
      Vec3 middle = Vec3::Zero();
      for (const std::size_t v : one.beside) middle += mesh.positions[v].cast<double>();
      Vec3 at = mesh.positions[one.vertex].cast<double>();
      if (round < kHandRounds) at += 0.5 * one.share * (middle / static_cast<double>(one.beside.size()) - at);
      moved[one.vertex] = onHand(*one.arm, at, one.share, blend).cast<float>();
    }
    mesh.positions = moved;
  }
  for (const HandVertex& one : hands) {
    Vector3f& normal = mesh.normals[one.vertex];
    const Vec3 at = mesh.positions[one.vertex].cast<double>();
    const Vec3 out = handSlope(*one.arm, at, handValue(*one.arm, at, kParted), kParted).normalized();
    normal = ((1 - one.share) * normal.cast<double>() + one.share * out).normalized().cast<float>();
  }
}

// How a hand at ease bends its first and its last finger, rad: at the knuckle and at a joint.
constexpr std::array<double, 2> kKnuckleBend{-0.05, 0.22}, kJointBend{0.18, 0.50};
constexpr double kJoint = 0.5;                      // of the longest finger
constexpr double kKnuckle = 0.012, kBend = 0.0065;  // m to either side, over which they bend

// Bends the hand across all fingers, the last one most: they touch, and none may leave the others.
void closeAtEase(std::span<const HandVertex> hands, SkinnedMesh& mesh) {
  for (const HandVertex& one : hands) {
    const ArmShape& arm = *one.arm;
    const RoundCone &first = arm.digits.front(), &longest = arm.digits[1], &last = arm.digits.back();
    const Vec3 along = (longest.b - longest.a).normalized(), across = last.a - first.a;
    Vec3 at = mesh.positions[one.vertex].cast<double>(), normal = mesh.normals[one.vertex].cast<double>();
    const double reached = along.dot(at - arm.knuckle), joint = kJoint * along.dot(longest.b - arm.knuckle);
    const double finger = std::clamp(across.dot(at - first.a) / across.squaredNorm(), 0.0, 1.0);
    const auto bend = [&](double place, double width, const std::array<double, 2>& angle) {
      const double share = one.share * smoothstep(place - width, place + width, reached);
      const Eigen::AngleAxisd turn(share * std::lerp(angle[0], angle[1], finger), arm.bend_axis);
      const Vec3 about = arm.knuckle + place * along;
      at = about + turn * (at - about);
      normal = turn * normal;
    };
    bend(joint, kBend, kJointBend);
    bend(0, kKnuckle, kKnuckleBend);
    mesh.positions[one.vertex] = at.cast<float>();
    mesh.normals[one.vertex] = normal.cast<float>();
  }
}

}  // namespace

SkinnedMesh withFingers(const SkinnedMesh& mesh, const BodyField& body) {
  SkinnedMesh fine = mesh;
  for (int k = 0; k < kHandHalvings; ++k) {
    std::vector<bool> inside;
    for (const Vector3f& p : fine.positions) inside.push_back(armOf(body, p.cast<double>()) != nullptr);
    halveEdges(inside, fine);
  }
  const std::vector<HandVertex> hands = handVertices(fine, body);
  drawOntoHands(hands, fine);
  closeAtEase(hands, fine);
  return fine;
}

}  // namespace app
