#include "app/figure/body_sdf.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace app {

namespace {

constexpr float kBelongs = 0.35f;    // share of a vertex's weights from which it belongs to a part; parts overlap
constexpr double kFinest = 0.005;    // m, spacing of the grids
constexpr double kNodesAlong = 128;  // at most about so many nodes along a part
constexpr double kMaxNodes = 1.5e6;  // of one grid
constexpr int kMinTriangles = 12;
constexpr float kCarries = 0.5f, kHolds = 0.8f;  // shares of a vertex's weights: from half on more and more, then all

// The joint with an ellipsoid that a joint moves with: itself or the nearest above it; -1: none.
std::vector<int> carriers(const Character& character) {
  std::vector<int> carrier(character.skeleton.joints.size(), -1);
  for (const BodyEllipsoid& e : character.ellipsoids) carrier[e.joint] = e.joint;
  for (std::size_t j = 0; j < carrier.size(); ++j) {
    const int parent = character.skeleton.joints[j].parent;
    if (carrier[j] < 0 && parent >= 0) carrier[j] = carrier[parent];
  }
  return carrier;
}

// Vertices at one place are one: files split them along seams of texture or normals.
std::vector<int> weldedIndices(const std::vector<Eigen::Vector3f>& positions) {
  std::map<std::array<float, 3>, int> seen;
  std::vector<int> welded;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const auto& p = positions[v];
    welded.push_back(seen.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(v)).first->second);
  }
  return welded;
}

// Closes every hole of a piece of surface by a fan around the middle of its rim. Returns how many there were.
int closeHoles(const std::vector<std::array<int, 3>>& faces, const std::vector<Vec3>& points,
               std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, int> sides;
  for (const auto& f : faces) {
    for (int k = 0; k < 3; ++k) ++sides[{f[k], f[(k + 1) % 3]}];
  }
  std::multimap<int, int> rim;
  for (const auto& [side, count] : sides) {
    if (!sides.contains({side.second, side.first})) rim.emplace(side.first, side.second);
  }
  int holes = 0;
  while (!rim.empty()) {
    std::vector<int> loop;
    int at = rim.begin()->first;
    for (auto next = rim.find(at); next != rim.end(); next = rim.find(at)) {
      loop.push_back(at);
      at = next->second;
      rim.erase(next);
    }
    if (loop.size() < 3) continue;
    Vec3 middle = Vec3::Zero();
    for (const int v : loop) middle += points[v] / static_cast<double>(loop.size());
    for (std::size_t k = 0; k < loop.size(); ++k)
      triangles.push_back({points[loop[(k + 1) % loop.size()]], points[loop[k]], middle});
    ++holes;
  }
  return holes;
}

PartDistance makePart(int joint, const std::vector<std::array<int, 3>>& faces, const std::vector<Vec3>& points) {
  PartDistance part;
  part.joint = joint;
  std::vector<Triangle> triangles;
  for (const auto& f : faces) triangles.push_back({points[f[0]], points[f[1]], points[f[2]]});
  part.triangles = static_cast<int>(triangles.size());
  part.holes = closeHoles(faces, points, triangles);
  Vec3 low = triangles[0][0], high = low;
  for (const Triangle& t : triangles) {
    for (const Vec3& p : t) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  const Vec3 size = high - low;
  const double spacing =
      std::max({kFinest, size.maxCoeff() / kNodesAlong, std::cbrt(std::max(size.prod(), 1e-9) / kMaxNodes)});
  const Vec3 pad = Vec3::Constant(3 * spacing);
  part.grid = layOutGrid(low - pad, high + pad, spacing);
  fillGrid(triangles, 2.5 * spacing, Pieces::kOneSolid, part.grid);
  for (const float d : part.grid.distance) part.deepest = std::max(part.deepest, -static_cast<double>(d));
  part.center = 0.5 * (low + high);
  part.radius = 0.5 * size.norm() + 2 * spacing;
  return part;
}

// Of those joints that `wanted` has.
template <class Wanted>
std::vector<PartDistance> partsOf(const Character& character, const Wanted& wanted) {
  const SkinnedMesh& mesh = character.mesh;
  const std::vector<int> carrier = carriers(character), welded = weldedIndices(mesh.positions);
  std::vector<PartDistance> parts;
  for (int joint = 0; joint < static_cast<int>(carrier.size()); ++joint) {
    if (carrier[joint] != joint || !wanted(joint)) continue;
    std::vector<unsigned char> belongs(mesh.positions.size(), 0);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      float weight = 0;
      for (int k = 0; k < 4; ++k) weight += carrier[mesh.joints[v][k]] == joint ? mesh.weights[v][k] : 0.0f;
      belongs[v] = weight > kBelongs;
    }
    const Rigid to_joint = character.skeleton.joints[joint].rest_world.inverse();
    std::vector<Vec3> points(mesh.positions.size());
    for (std::size_t v = 0; v < points.size(); ++v) points[v] = to_joint * mesh.positions[v].cast<double>();
    std::vector<std::array<int, 3>> faces;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const std::uint32_t* i = mesh.triangles.data() + t;
      if (!belongs[i[0]] && !belongs[i[1]] && !belongs[i[2]]) continue;
      faces.push_back({welded[i[0]], welded[i[1]], welded[i[2]]});
    }
    if (static_cast<int>(faces.size()) < kMinTriangles) continue;
    PartDistance part = makePart(joint, faces, points);
    if (part.deepest > 0) parts.push_back(std::move(part));
  }
  return parts;
}

// A part moves as one, and skin that it carries for the most part with it: files leave small weights of far joints on
// skin, and a limb that swings would shift a head by centimetres against its distances and the hair's roots.
void holdSkin(const std::vector<unsigned char>& rigid, const std::vector<int>& carrier, SkinnedMesh& mesh) {
  for (std::size_t v = 0; v < mesh.weights.size(); ++v) {
    std::array<float, 4>& weights = mesh.weights[v];
    for (int k = 0; k < 4; ++k) {
      const int part = carrier[mesh.joints[v][k]];
      if (part < 0 || !rigid[static_cast<std::size_t>(part)]) continue;
      const auto own = [&](int other) { return carrier[mesh.joints[v][other]] == part; };
      float share = 0;
      for (int other = 0; other < 4; ++other) share += own(other) ? weights[other] : 0.0f;
      if (share <= kCarries || share >= 1) continue;
      const float held = std::min(1.0f, kCarries + (share - kCarries) * (1 - kCarries) / (kHolds - kCarries));
      for (int other = 0; other < 4; ++other) weights[other] *= own(other) ? held / share : (1 - held) / (1 - share);
      break;
    }
  }
}

}  // namespace

std::vector<PartDistance> partDistances(const Character& character) {
  return partsOf(character, [](int) { return true; });
}

std::vector<PartDistance> unfitPartDistances(Character& character) {
  std::vector<unsigned char> unfit(character.skeleton.joints.size(), 0), made(unfit.size(), 0);
  for (const BodyEllipsoid& e : character.ellipsoids) unfit[e.joint] |= static_cast<unsigned char>(e.by_distances);
  if (std::ranges::find(unfit, 1) == unfit.end()) return {};
  std::vector<PartDistance> parts = partsOf(character, [&](int joint) { return unfit[joint] != 0; });
  for (const PartDistance& part : parts) made[part.joint] = 1;
  for (BodyEllipsoid& e : character.ellipsoids) e.by_distances = made[e.joint] != 0;
  holdSkin(made, carriers(character), character.mesh);
  return parts;
}

void posePartDistance(const PartDistance& part, const Pose& pose, const Pose& previous, double dt,
                      sim::BodySdf& posed) {
  // The grid's frame is the joint's, its box lies about the centre.
  BodyEllipsoid ball;
  ball.joint = part.joint;
  ball.center = part.center;
  ball.radii = Vec3::Constant(part.radius);
  poseEllipsoid(ball, pose, previous, dt, posed.bounds);
  sim::DistanceGrid& grid = posed.grid;
  grid.low = part.grid.low - part.center;
  grid.spacing = part.grid.h;
  grid.nodes = part.grid.n;
  grid.values = part.grid.distance;
  grid.deepest = part.deepest;
}

void posePartDistances(const std::vector<PartDistance>& parts, const Pose& pose, const Pose& previous, double dt,
                       std::vector<sim::BodySdf>& posed) {
  posed.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) posePartDistance(parts[k], pose, previous, dt, posed[k]);
}

}  // namespace app
