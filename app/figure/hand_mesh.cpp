#include "app/figure/hand_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "app/figure/smoothstep.h"

namespace app {

namespace {

using ArmShape = BodyField::ArmShape;
using Eigen::Vector3f;

constexpr int kHandHalvings = 2;                    // of the mesh's edges
constexpr int kHandRounds = 30;                     // see drawOntoHands
constexpr double kPaddle = 0.04, kParted = 0.0025;  // m, blends of fingers
constexpr double kMittenSkin = 0.007;               // m off the mitten that is still its skin
constexpr double kHandStep = 3e-4;                  // m

double mittenValue(const ArmShape& arm, const Vec3& p) {
  return smoothMin(smoothMin(arm.palm.value(p), arm.fingers.value(p), 0.02), arm.thumb.value(p), 0.018);
}

// `blend`: m over which fingers run into one another.
double handValue(const ArmShape& arm, const Vec3& p, double blend) {
  double digits = arm.digits[0].value(p);
  for (std::size_t k = 1; k < arm.digits.size(); ++k) digits = smoothMin(digits, arm.digits[k].value(p), blend);
  return smoothMin(smoothMin(arm.palm.value(p), digits, 0.024), arm.thumb.value(p), 0.014);
}

Vec3 handSlope(const ArmShape& arm, const Vec3& p, double blend) {
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kHandStep * Vec3::Unit(axis);
    slope[axis] = (handValue(arm, p + step, blend) - handValue(arm, p - step, blend)) / (2 * kHandStep);
  }
  return slope;
}

// 0 at the wrist and elsewhere, 1 from the middle of the palm on.
double handShare(const ArmShape& arm, const Vec3& p) {
  const double share = smoothstep(0.15, 0.6, arm.palm.along(p));
  return arm.present && share > 0 && mittenValue(arm, p) < kMittenSkin ? share : 0;
}

const ArmShape* armOf(const BodyField& body, const Vec3& p) {
  for (const ArmShape& arm : body.arms) {
    if (handShare(arm, p) > 0) return &arm;
  }
  return nullptr;
}

// Joints of two vertices, the four heaviest of their mean.
void meanJoints(int a, int b, SkinnedMesh& mesh) {
  std::map<std::uint16_t, float> sum;
  for (const int v : {a, b}) {
    for (std::size_t k = 0; k < 4; ++k) sum[mesh.joints[v][k]] += 0.5f * mesh.weights[v][k];
  }
  std::vector<std::pair<float, std::uint16_t>> sorted;
  for (const auto& [joint, weight] : sum) sorted.emplace_back(-weight, joint);
  std::ranges::sort(sorted);
  sorted.resize(4, {0.0f, sorted.front().second});
  float whole = 0;
  for (const auto& [weight, joint] : sorted) whole -= weight;
  std::array<std::uint16_t, 4> joints;
  std::array<float, 4> weights;
  for (std::size_t k = 0; k < 4; ++k) joints[k] = sorted[k].second, weights[k] = -sorted[k].first / whole;
  mesh.joints.push_back(joints);
  mesh.weights.push_back(weights);
}

class HandHalver {
 public:
  explicit HandHalver(SkinnedMesh& mesh) : mesh_(mesh) {}

  // Halves every edge whose ends are both `inside`; triangles beside them are divided along.
  void halve(const std::vector<bool>& inside) {
    std::vector<std::uint32_t> triangles;
    const auto add = [&](int a, int b, int c) {
      for (const int v : {a, b, c}) triangles.push_back(static_cast<std::uint32_t>(v));
    };
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += 3) {
      std::array<int, 3> v, middle;
      for (std::size_t k = 0; k < 3; ++k) v[k] = static_cast<int>(mesh_.triangles[t + k]);
      int halved = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = v[k], b = v[(k + 1) % 3];
        middle[k] = inside[static_cast<std::size_t>(a)] && inside[static_cast<std::size_t>(b)] ? middleOf(a, b) : -1;
        halved += middle[k] >= 0;
      }
      // Turned so that a single edge comes first, or that the one left whole comes last.
      while ((halved == 1 && middle[0] < 0) || (halved == 2 && middle[2] >= 0)) {
        std::rotate(v.begin(), v.begin() + 1, v.end());
        std::rotate(middle.begin(), middle.begin() + 1, middle.end());
      }
      if (halved == 0) add(v[0], v[1], v[2]);
      if (halved == 1) add(v[0], middle[0], v[2]), add(middle[0], v[1], v[2]);
      if (halved == 2) add(middle[0], v[1], middle[1]), add(v[0], middle[0], middle[1]), add(v[0], middle[1], v[2]);
      if (halved == 3) {
        for (std::size_t k = 0; k < 3; ++k) add(v[k], middle[k], middle[(k + 2) % 3]);
        add(middle[0], middle[1], middle[2]);
      }
    }
    mesh_.triangles = std::move(triangles);
    made_.clear();
  }

 private:
  int middleOf(int a, int b) {
    const auto [at, fresh] = made_.try_emplace(std::minmax(a, b), static_cast<int>(mesh_.positions.size()));
    if (!fresh) return at->second;
    mesh_.positions.push_back(Vector3f(0.5f * (mesh_.positions[a] + mesh_.positions[b])));
    mesh_.normals.push_back((mesh_.normals[a] + mesh_.normals[b]).normalized());
    if (!mesh_.cloth.empty()) mesh_.cloth.push_back(0.5f * (mesh_.cloth[a] + mesh_.cloth[b]));
    meanJoints(a, b, mesh_);
    return at->second;
  }

  SkinnedMesh& mesh_;
  std::map<std::pair<int, int>, int> made_;
};

// To the hand's surface, as far as `share` says.
Vec3 onHand(const ArmShape& arm, const Vec3& from, double share, double blend) {
  const Vec3 out = handSlope(arm, from, blend);
  return from - share * handValue(arm, from, blend) / std::max(out.squaredNorm(), 0.1) * out;
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
void drawOntoHands(const BodyField& body, SkinnedMesh& mesh) {
  const std::vector<HandVertex> hands = handVertices(mesh, body);
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
    const Vec3 out = handSlope(*one.arm, mesh.positions[one.vertex].cast<double>(), kParted).normalized();
    normal = ((1 - one.share) * normal.cast<double>() + one.share * out).normalized().cast<float>();
  }
}

}  // namespace

SkinnedMesh withFingers(const SkinnedMesh& mesh, const BodyField& body) {
  SkinnedMesh fine = mesh;
  HandHalver halver(fine);
  for (int k = 0; k < kHandHalvings; ++k) {
    std::vector<bool> inside;
    for (const Vector3f& p : fine.positions) inside.push_back(armOf(body, p.cast<double>()) != nullptr);
    halver.halve(inside);
  }
  drawOntoHands(body, fine);
  return fine;
}

}  // namespace app
