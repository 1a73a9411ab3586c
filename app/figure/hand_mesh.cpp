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

constexpr int kHandHalvings = 2;       // of the mesh's edges
constexpr int kToSkin = 5;             // of the way to the surface
constexpr double kFarthest = 0.012;    // m, of that way at most
constexpr double kMittenSkin = 0.007;  // m off the mitten that is still its skin
constexpr double kHandStep = 3e-4;     // m

double mittenValue(const ArmShape& arm, const Vec3& p) {
  return smoothMin(smoothMin(arm.palm.value(p), arm.fingers.value(p), 0.02), arm.thumb.value(p), 0.018);
}

double handValue(const ArmShape& arm, const Vec3& p) {
  double digits = arm.digits[0].value(p);
  for (std::size_t k = 1; k < arm.digits.size(); ++k) digits = smoothMin(digits, arm.digits[k].value(p), 0.0025);
  return smoothMin(smoothMin(arm.palm.value(p), digits, 0.012), arm.thumb.value(p), 0.012);
}

Vec3 handSlope(const ArmShape& arm, const Vec3& p) {
  Vec3 slope;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kHandStep * Vec3::Unit(axis);
    slope[axis] = (handValue(arm, p + step) - handValue(arm, p - step)) / (2 * kHandStep);
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

void drawOntoHand(const ArmShape& arm, Vector3f& position, Vector3f& normal) {
  const Vec3 from = position.cast<double>();
  const double share = handShare(arm, from);
  Vec3 p = from, out = handSlope(arm, p);
  for (int k = 0; k < kToSkin; ++k) {
    p -= handValue(arm, p) * out / std::max(out.squaredNorm(), 0.1);
    out = handSlope(arm, p);
  }
  Vec3 way = p - from;
  if (way.norm() > kFarthest) way *= kFarthest / way.norm();
  position = (from + share * way).cast<float>();
  normal = ((1 - share) * normal.cast<double>() + share * out.normalized()).normalized().cast<float>();
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
  for (std::size_t v = 0; v < fine.positions.size(); ++v) {
    const ArmShape* arm = armOf(body, fine.positions[v].cast<double>());
    if (arm) drawOntoHand(*arm, fine.positions[v], fine.normals[v]);
  }
  return fine;
}

}  // namespace app
