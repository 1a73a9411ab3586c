#include "app/figure/root_cover.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

#include "app/figure/kept.h"
#include "app/figure/smoothstep.h"

namespace app {

namespace {

// On a head of this height; in proportion on others.
constexpr double kHeadHeight = 0.23;   // m
constexpr double kShadeReach = 0.008;  // m, along the skin: how far a root shades the skin around it
// The same, over which hair thins towards the hairline (`hairline`, by default): the skin shows there as it does
// between few hairs.
constexpr double kThinReach = 0.018;
constexpr double kSpacing = 0.003;  // m, between the samples of a root face
// m between skin and root, across the skin: as good as on it up to the first, of another head from the second on.
constexpr double kNear = 0.012, kApart = 0.018;
constexpr double kOnScalp = 0.002, kOnEar = 0.006;  // m of skin above the scalp, which is without ears
constexpr double kMargin = 0.0003;                  // m that the skin is drawn below the roots

// Share of the skin around that bears roots, from which on it counts and at which it is covered. Along a straight
// hairline it is a half.
constexpr double kBare = 0.06, kFull = 0.9;
constexpr double kThin = 0.55, kThick = 0.85;  // the same within kThinReach: bare and covered

// A piece of a root face.
struct RootSample {
  Vec3 place, normal;  // normal: unit
  double area;         // m^2
};

// Cuts a root face into pieces about `spacing` wide: of the bilinear patch, folded over its diagonal for triangles.
void addFace(const sim::HairMeshShape& shape, const sim::RootFace& face, double spacing,
             std::vector<RootSample>& samples) {
  const auto root = [&](int k) -> const Vec3& { return shape.positions[shape.column_first[face.columns[k]]]; };
  const bool triangle = face.corner_count == 3;
  const Vec3 a = root(0), b = root(1), c = root(2), d = triangle ? c : root(3);
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (d - c).norm(), (a - d).norm()});
  const int cuts = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 100);
  for (int i = 0; i < cuts; ++i) {
    for (int j = 0; j < cuts; ++j) {
      // The last corner of a triangle twice: the patch narrows to it, and its pieces with it.
      const double u = (i + 0.5) / cuts, v = (j + 0.5) / cuts;
      const Vec3 across = ((1 - v) * (b - a) + v * (c - d)).cross((1 - u) * (d - a) + u * (c - b));
      const double area = across.norm() / (cuts * cuts);
      if (!(area > 1e-12)) continue;
      samples.push_back({(1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c), across.normalized(), area});
    }
  }
}

// Vertices by the cube that they lie in.
class Cubes {
 public:
  explicit Cubes(double side) : side_(side) {}
  void add(const Vec3& p, int vertex) { vertices_[key(cube(p))].push_back(vertex); }

  // Calls `visit` with every vertex less than a side away from p, and some more.
  template <class Visit>
  void around(const Vec3& p, const Visit& visit) const {
    const Eigen::Vector3i middle = cube(p);
    for (int n = 0; n < 27; ++n) {
      const auto at = vertices_.find(key(middle + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (at == vertices_.end()) continue;
      for (const int vertex : at->second) visit(vertex);
    }
  }

 private:
  Eigen::Vector3i cube(const Vec3& p) const { return (p / side_).array().floor().max(-1e6).min(1e6).cast<int>(); }
  static std::uint64_t key(const Eigen::Vector3i& cube) {
    const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)); };
    return part(cube.x()) << 42 | part(cube.y()) << 21 | part(cube.z());
  }

  double side_;
  std::unordered_map<std::uint64_t, std::vector<int>> vertices_;
};

std::vector<float> coverOf(const Character& character, const sim::HairMeshShape& hair) {
  const SkinnedMesh& mesh = character.mesh;
  const double scale = character.scalp.head_height / kHeadHeight;
  const Rigid to_scalp = scalpToWorld(character, restPose(character.skeleton)).inverse();
  const std::size_t count = mesh.positions.size();
  std::vector<Vec3> places(count), normals(count);
  std::vector<double> on_scalp(count), share(count, 0.0), around(count, 0.0), depth(count, 0.0);
  Cubes cubes(scale * std::hypot(kThinReach, kApart));
  for (std::size_t v = 0; v < count; ++v) {
    places[v] = to_scalp * mesh.positions[v].cast<double>();
    normals[v] = to_scalp.linear() * mesh.normals[v].cast<double>();
    const Vec3 from = places[v] - character.scalp.center;
    on_scalp[v] = smoothstep(scale * kOnEar, scale * kOnScalp, from.norm() - character.scalp.radiusAt(from));
    if (on_scalp[v] > 0) cubes.add(places[v], static_cast<int>(v));
  }
  std::vector<RootSample> samples;
  for (const sim::RootFace& face : hair.root_faces) addFace(hair, face, scale * kSpacing, samples);

  // The weight (1 - d^2 / reach^2)^2 spreads each root's area; over a plane it integrates to pi reach^2 / 3.
  const auto spread = [](double square, double reach) {
    const double left = std::max(0.0, 1 - square / (reach * reach));
    return left * left * 3 / (EIGEN_PI * reach * reach);
  };
  const double apart = scale * kApart, reach = scale * kThinReach;  // beyond either all weights are zero
  for (const RootSample& sample : samples) {
    cubes.around(sample.place, [&](int v) {
      const Vec3 gap = places[v] - sample.place;
      const double above = gap.dot(sample.normal), square = gap.squaredNorm() - above * above;
      if (std::abs(above) >= apart || square >= reach * reach) return;
      const double facing = std::max(0.0, normals[v].dot(sample.normal));
      const double on_it = smoothstep(scale * kApart, scale * kNear, std::abs(above));
      const double area = sample.area * facing * on_it * on_scalp[v];
      const double weight = area * spread(square, scale * kShadeReach);
      share[v] += weight;
      depth[v] += weight * above;
      around[v] += area * spread(square, scale * kThinReach);
    });
  }
  std::vector<float> result;
  result.reserve(2 * count);
  for (std::size_t v = 0; v < count; ++v) {
    const double cover = smoothstep(kBare, kFull, share[v]);
    const double under = cover > 0 ? std::max(0.0, depth[v] / share[v] + scale * kMargin) : 0.0;
    const double thick = smoothstep(kThin, kThick, around[v]);
    result.insert(result.end(), {static_cast<float>(cover * thick), static_cast<float>(cover * under)});
  }
  return result;
}

}  // namespace

std::vector<float> rootCover(const Character& character, const sim::HairMesh& hair) {
  static Kept<std::vector<float>> kept;
  std::string key = restSurfaceBytes(character);
  addBytes(character.mesh.normals, key);
  std::vector<Vec3> corners;
  for (const sim::RootFace& face : hair.shape.root_faces) {
    for (int k = 0; k < 4; ++k) {
      const int column = face.columns[static_cast<std::size_t>(std::min(k, face.corner_count - 1))];
      corners.push_back(hair.shape.positions[static_cast<std::size_t>(hair.shape.column_first[column])]);
    }
  }
  addBytes(corners, key);
  return kept.get(key, [&] { return coverOf(character, hair.shape); });
}

}  // namespace app
