#include "tests/skin/drawn_skin.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "render/body/skinning.h"

namespace skin {
namespace {

constexpr float kAtSkin = 0.0005f;  // m: nothing hangs on points so near

// Not along the axes, that a mesh's edges like to follow.
const std::array<Vector3f, 2> kDirections{Vector3f(0.9741f, 0.1303f, 0.1850f).normalized(),
                                          Vector3f(-0.1711f, 0.9562f, -0.2374f).normalized()};

// Piece of every vertex: vertices at one place of the rest pose, and those of a triangle, belong together.
std::vector<int> piecesOf(const render::BodyInput& body, int& count) {
  std::vector<int> above(body.positions.size() / 3);
  std::iota(above.begin(), above.end(), 0);
  const auto top = [&](int v) {
    while (above[v] != v) v = above[v] = above[above[v]];
    return v;
  };
  std::map<std::array<float, 3>, int> seen;
  for (int v = 0; v < static_cast<int>(above.size()); ++v) {
    const float* p = &body.positions[3 * v];
    above[top(v)] = top(seen.try_emplace({p[0], p[1], p[2]}, v).first->second);
  }
  for (std::size_t t = 0; t + 2 < body.triangles.size(); t += 3) {
    for (int k = 1; k < 3; ++k)
      above[top(static_cast<int>(body.triangles[t + k]))] = top(static_cast<int>(body.triangles[t]));
  }
  std::map<int, int> numbers;
  std::vector<int> pieces;
  for (int v = 0; v < static_cast<int>(above.size()); ++v)
    pieces.push_back(numbers.try_emplace(top(v), static_cast<int>(numbers.size())).first->second);
  count = static_cast<int>(numbers.size());
  return pieces;
}

struct Crossings : RTCIntersectContext {
  std::vector<int>* windings;  // per piece
};

// Counts a crossing and lets the ray go on.
void countCrossing(const RTCFilterFunctionNArguments* args) {
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
  const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
  const float along = hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z;
  (*static_cast<Crossings*>(args->context)->windings)[hit->geomID] += along > 0 ? 1 : -1;
  args->valid[0] = 0;
}

struct Nearest {
  unsigned piece;
  float distance;
  const std::vector<std::vector<std::uint32_t>>* triangles;
  const std::vector<Vector3f>* vertices;
};

float segmentDistance(const Vector3f& p, const Vector3f& a, const Vector3f& b) {
  const Vector3f d = b - a;
  const float t = std::clamp((p - a).dot(d) / std::max(d.squaredNorm(), 1e-20f), 0.0f, 1.0f);
  return (p - a - t * d).norm();
}

float triangleDistance(const Vector3f& p, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
  const Vector3f n = (b - a).cross(c - a);
  const float size = n.squaredNorm();
  if (size > 0) {
    const Vector3f w = p - a;
    const float second = w.cross(c - a).dot(n) / size, third = (b - a).cross(w).dot(n) / size;
    if (second >= 0 && third >= 0 && second + third <= 1) return std::abs(w.dot(n)) / std::sqrt(size);
  }
  return std::min({segmentDistance(p, a, b), segmentDistance(p, b, c), segmentDistance(p, c, a)});
}

// How often triangles go round a point: 1 inside a closed piece, 0 outside; of an open one the share of all directions
// in which its inside is seen (van Oosterom and Strackee 1983).
double windingNumber(const Vector3f& p, const std::vector<std::uint32_t>& triangles,
                     const std::vector<Vector3f>& vertices) {
  double angle = 0;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const auto to = [&](std::size_t k) { return (vertices[triangles[t + k]] - p).cast<double>().eval(); };
    const Eigen::Vector3d a = to(0), b = to(1), c = to(2);
    const double x = a.norm(), y = b.norm(), z = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
  }
  return angle / (4 * std::numbers::pi);
}

bool visitTriangle(RTCPointQueryFunctionArguments* args) {
  Nearest& nearest = *static_cast<Nearest*>(args->userPtr);
  if (args->geomID != nearest.piece) return false;
  const std::uint32_t* t = &(*nearest.triangles)[args->geomID][3 * args->primID];
  const auto& v = *nearest.vertices;
  const float d = triangleDistance({args->query->x, args->query->y, args->query->z}, v[t[0]], v[t[1]], v[t[2]]);
  if (d >= nearest.distance) return false;
  nearest.distance = args->query->radius = d;
  return true;
}

}  // namespace

std::vector<Vector3f> skinned(const render::BodyInput& body) {
  return render::skinnedPositions(body);
}

struct DrawnSkin::Tree {
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);
  std::vector<std::vector<std::uint32_t>> triangles;  // per piece
  mutable std::array<std::vector<int>, 2> windings;   // per direction and piece

  ~Tree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

DrawnSkin::DrawnSkin(const render::BodyInput& body) : vertices_(skinned(body)), tree_(std::make_unique<Tree>()) {
  int count = 0;
  const std::vector<int> pieces = piecesOf(body, count);
  tree_->triangles.resize(static_cast<std::size_t>(count));
  for (auto& windings : tree_->windings) windings.resize(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t + 2 < body.triangles.size(); t += 3) {
    auto& piece = tree_->triangles[pieces[body.triangles[t]]];
    piece.insert(piece.end(), {body.triangles[t], body.triangles[t + 1], body.triangles[t + 2]});
  }
  rtcSetSceneFlags(tree_->scene,
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  vertices_.emplace_back(Vector3f::Zero());  // Embree reads a little past the last one
  for (unsigned piece = 0; piece < tree_->triangles.size(); ++piece) {
    const auto& triangles = tree_->triangles[piece];
    const RTCGeometry geometry = rtcNewGeometry(tree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices_.data(), 0, 12,
                               vertices_.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0, 12,
                               triangles.size() / 3);
    rtcSetGeometryPointQueryFunction(geometry, visitTriangle);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(tree_->scene, geometry, piece);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(tree_->scene);
}

DrawnSkin::~DrawnSkin() = default;
DrawnSkin::DrawnSkin(DrawnSkin&&) noexcept = default;

float DrawnSkin::depth(const Vector3f& p) const {
  const auto cross = [&](int direction) {
    auto& windings = tree_->windings[static_cast<std::size_t>(direction)];
    std::fill(windings.begin(), windings.end(), 0);
    Crossings context;
    rtcInitIntersectContext(&context);
    context.filter = countCrossing;
    context.windings = &windings;
    const Vector3f& to = kDirections[static_cast<std::size_t>(direction)];
    RTCRayHit ray{};
    ray.ray = {p.x(), p.y(), p.z(), 0, to.x(), to.y(), to.z(), 0, std::numeric_limits<float>::infinity(), ~0u, 0, 0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree_->scene, &context, &ray);
    return std::any_of(windings.begin(), windings.end(), [](int w) { return w > 0; });
  };
  // Rays are quick and holes lead them astray: of points deep inside by one of two all triangles are asked.
  const bool first = cross(0), second = cross(1);
  if (!first && !second) return 0;
  float deepest = 0;
  for (unsigned piece = 0; piece < tree_->triangles.size(); ++piece) {
    if (tree_->windings[0][piece] <= 0 && tree_->windings[1][piece] <= 0) continue;
    RTCPointQuery query{p.x(), p.y(), p.z(), 0, std::numeric_limits<float>::infinity()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    Nearest nearest{piece, std::numeric_limits<float>::infinity(), &tree_->triangles, &vertices_};
    rtcPointQuery(tree_->scene, &query, &context, nullptr, &nearest);
    if (nearest.distance > kAtSkin && windingNumber(p, tree_->triangles[piece], vertices_) < 0.5) continue;
    deepest = std::max(deepest, nearest.distance);
  }
  return deepest;
}

}  // namespace skin
