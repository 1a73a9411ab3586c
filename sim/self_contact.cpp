#include "sim/self_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace sim {
namespace {

constexpr double kMarginShare = 0.25;  // of the mean length of the edges along the hair
constexpr double kRestMargin = 0.002;  // m; pairs as near as this in the rest shape are no contacts
constexpr int kPasses = 8;             // at most, over the pairs: one push may press others together

struct Plane {
  Vec3 normal, middle;
};

Plane planeOf(const BoundaryPrism::Face& face, std::span<const Vec3> x) {
  const Vec3 &a = x[face.v[0]], &b = x[face.v[1]], &c = x[face.v[2]];
  if (face.corner_count == 3) return {(b - a).cross(c - a), (a + b + c) / 3};
  const Vec3& d = x[face.v[3]];
  return {(c - a).cross(d - b), (a + b + c + d) / 4};
}

struct Inside {
  int face = -1;     // external face with the shortest way out; -1: outside
  double depth = 0;  // m
  Vec3 normal = Vec3::UnitY();
};

// Where p lies in a prism: below all of its faces' mean planes by -margin at least. Prisms that are turned over or flat
// have no inside.
Inside insideOf(const BoundaryPrism& prism, std::span<const Vec3> x, const Vec3& p, double margin) {
  Inside inside;
  inside.depth = INFINITY;
  Vec3 centre = Vec3::Zero();
  for (const int f : {0, 1}) centre += planeOf(prism.faces[f], x).middle / 2;
  for (int f = 0; f < prism.face_count; ++f) {
    const Plane plane = planeOf(prism.faces[f], x);
    const double size = plane.normal.norm();
    if (!(size > 0)) return {};
    const Vec3 normal = plane.normal / size;
    const double below = normal.dot(plane.middle - p);
    if (below < -margin || normal.dot(plane.middle - centre) <= 0) return {};
    if (prism.faces[f].external && below < inside.depth) inside.depth = below, inside.face = f, inside.normal = normal;
  }
  return inside;
}

// Weights of a face's corners at p: barycentric in that triangle of the face that p lies over.
std::array<double, 4> cornerWeights(const BoundaryPrism::Face& face, std::span<const Vec3> x, const Vec3& p) {
  std::array<double, 4> weights{};
  const auto inTriangle = [&](int i, int j, int k) {
    const Vec3 a = x[face.v[i]], u = x[face.v[j]] - a, v = x[face.v[k]] - a, w = p - a;
    const Vec3 n = u.cross(v);
    const double size = n.squaredNorm();
    if (!(size > 0)) return weights[i] = 1, false;
    const double second = w.cross(v).dot(n) / size, third = u.cross(w).dot(n) / size, first = 1 - second - third;
    const double sum = std::max(first, 0.0) + std::max(second, 0.0) + std::max(third, 0.0);
    weights = {};
    weights[i] = std::max(first, 0.0) / sum, weights[j] = std::max(second, 0.0) / sum;
    weights[k] = std::max(third, 0.0) / sum;
    return second >= 0;
  };
  // Over the first triangle unless p lies beyond the diagonal.
  if (!inTriangle(0, 1, 2) && face.corner_count == 4) inTriangle(0, 2, 3);
  return weights;
}

// The scalp's frame: rows are its axes.
struct Frame {
  Eigen::Matrix3d axes;
  Vec3 origin;
};
Frame scalpFrame(const SelfContact& self, std::span<const Vec3> x) {
  const Vec3 &a = x[self.frame_roots[0]], &b = x[self.frame_roots[1]], &c = x[self.frame_roots[2]];
  Frame frame;
  frame.origin = a;
  const Vec3 first = (b - a).normalized(), third = (b - a).cross(c - a).normalized();
  frame.axes.row(0) = first.transpose();
  frame.axes.row(1) = third.cross(first).transpose();
  frame.axes.row(2) = third.transpose();
  return frame;
}

bool listHolds(const SelfContact& self, std::span<const Vec3> x) {
  if (self.listed_at.empty()) return false;
  const Frame frame = scalpFrame(self, x);
  const double most = self.margin * self.margin / 4;
  for (std::size_t i = 0; i < x.size(); ++i) {
    // Negated, so that a position that is not finite makes a new list.
    if (!((frame.axes * (x[i] - frame.origin) - self.listed_at[i]).squaredNorm() < most)) return false;
  }
  return true;
}

// Sweep along y, in which hair hangs out longest: prisms by their lower end, vertices against those that reach them.
void makeList(const HairMesh& mesh, std::span<const Vec3> x, SelfContact& self) {
  ++self.rebuilds;
  self.pairs.clear();
  const Frame frame = scalpFrame(self, x);
  self.listed_at.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) self.listed_at[i] = frame.axes * (x[i] - frame.origin);
  self.boxes.resize(self.prisms.size());
  double tallest = 0;
  for (std::size_t k = 0; k < self.prisms.size(); ++k) {
    const Prism& prism = mesh.prisms[self.prisms[k].prism];
    Vec3 low = x[prism.v[0]], high = low;
    for (int c = 1; c < 2 * prism.corner_count; ++c)
      low = low.cwiseMin(x[prism.v[c]]), high = high.cwiseMax(x[prism.v[c]]);
    self.boxes[k] = {low.array() - self.margin, high.array() + self.margin, static_cast<int>(k)};
    tallest = std::max(tallest, self.boxes[k].high.y() - self.boxes[k].low.y());
  }
  std::sort(self.boxes.begin(), self.boxes.end(), [](const auto& a, const auto& b) {
    return a.low.y() != b.low.y() ? a.low.y() < b.low.y() : a.prism < b.prism;
  });
  const int faces = static_cast<int>(mesh.shape.root_faces.size());
  for (const int v : mesh.external_vertices) {
    const std::size_t first = self.pairs.size();
    const unsigned char* own = self.own.data() + static_cast<std::size_t>(mesh.column_of[v]) * faces;
    auto box = std::lower_bound(self.boxes.begin(), self.boxes.end(), x[v].y() - tallest,
                                [](const auto& b, double y) { return b.low.y() < y; });
    for (; box != self.boxes.end() && box->low.y() <= x[v].y(); ++box) {
      if (!((x[v].array() >= box->low.array()).all() && (x[v].array() <= box->high.array()).all())) continue;
      const BoundaryPrism& prism = self.prisms[box->prism];
      if (own[mesh.prisms[prism.prism].root_face]) continue;
      if (insideOf(prism, mesh.shape.positions, mesh.shape.positions[v], kRestMargin).face >= 0) continue;
      self.pairs.push_back({v, box->prism});
    }
    std::sort(self.pairs.begin() + first, self.pairs.end(),
              [](const auto& a, const auto& b) { return a.prism < b.prism; });
  }
}

// Pushes vertex and face apart and takes their approach. m: kg, up to the common factor of density.
void resolvePair(const HairMesh& mesh, const SimParams& params, double most, const BoundaryPrism::Face& face,
                 const Inside& inside, HairState& state, int v) {
  const std::array<double, 4> weight = cornerWeights(face, state.positions, state.positions[v]);
  const double yield = 1 / mesh.vertex_volume[v];
  std::array<double, 4> give{};
  double sum = yield;
  Vec3 relative = state.velocities[v];
  for (int c = 0; c < face.corner_count; ++c) {
    give[c] = mesh.isRoot(face.v[c]) ? 0 : weight[c] / mesh.vertex_volume[face.v[c]];
    sum += weight[c] * give[c];
    relative -= weight[c] * state.velocities[face.v[c]];
  }
  const Vec3 push = std::min(inside.depth, most) / sum * inside.normal;
  const double approach = std::max(0.0, -relative.dot(inside.normal));
  const Vec3 slip = relative - relative.dot(inside.normal) * inside.normal;
  const double speed = slip.norm(), loss = std::min(speed, params.friction * approach);
  Vec3 impulse = approach * inside.normal;
  if (speed > 0) impulse -= loss / speed * slip;
  impulse /= sum;
  state.positions[v] += yield * push;
  state.velocities[v] += yield * impulse;
  for (int c = 0; c < face.corner_count; ++c) {
    state.positions[face.v[c]] -= give[c] * push;
    state.velocities[face.v[c]] -= give[c] * impulse;
  }
}

}  // namespace

SelfContact::SelfContact(const HairMesh& mesh) {
  std::set<std::array<int, 4>> outer;
  const auto key = [](int count, std::array<int, 4> v) {
    if (count == 3) v[3] = -1;
    std::sort(v.begin(), v.end());
    return v;
  };
  for (const ExternalFace& face : mesh.external_faces) outer.insert(key(face.corner_count, face.v));
  for (int p = 0; p < static_cast<int>(mesh.prisms.size()); ++p) {
    const Prism& prism = mesh.prisms[p];
    const int n = prism.corner_count;
    BoundaryPrism boundary{p, n + 2, {}};
    // Lower and upper face first: their middles' mean is the prism's centre.
    boundary.faces[0] = {n, {prism.v[0], prism.v[n - 1], prism.v[n - 2], n == 4 ? prism.v[1] : -1}, false};
    if (n == 3) boundary.faces[0].v = {prism.v[0], prism.v[2], prism.v[1], -1};
    boundary.faces[1] = {n, {prism.v[n], prism.v[n + 1], prism.v[n + 2], n == 4 ? prism.v[n + 3] : -1}, false};
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n;
      boundary.faces[2 + k] = {4, {prism.v[k], prism.v[next], prism.v[n + next], prism.v[n + k]}, false};
    }
    bool any = false;
    for (int f = 1; f < boundary.face_count; ++f) {
      boundary.faces[f].external = outer.contains(key(boundary.faces[f].corner_count, boundary.faces[f].v));
      any = any || boundary.faces[f].external;
    }
    if (any) prisms.push_back(boundary);
  }
  const auto& faces = mesh.shape.root_faces;
  std::vector<std::set<int>> around(mesh.columnCount());  // columns that share a root face
  for (const RootFace& face : faces) {
    for (int i = 0; i < face.corner_count; ++i)
      for (int k = 0; k < face.corner_count; ++k) around[face.columns[i]].insert(face.columns[k]);
  }
  own.assign(mesh.columnCount() * faces.size(), 0);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (int k = 0; k < faces[f].corner_count; ++k)
        own[c * faces.size() + f] |= around[c].contains(faces[f].columns[k]) ? 1 : 0;
    }
  }
  // The roots farthest from one another, so that the frame is exact.
  const auto root = [&](int c) { return mesh.shape.positions[mesh.shape.column_first[c]]; };
  std::array<int, 3> columns{0, 0, 0};
  for (int c = 1; c < mesh.columnCount(); ++c) {
    if ((root(c) - root(0)).norm() > (root(columns[1]) - root(0)).norm()) columns[1] = c;
  }
  const auto area = [&](int c) { return (root(columns[1]) - root(0)).cross(root(c) - root(0)).norm(); };
  for (int c = 1; c < mesh.columnCount(); ++c) {
    if (area(c) > area(columns[2])) columns[2] = c;
  }
  for (int k = 0; k < 3; ++k) frame_roots[k] = mesh.shape.column_first[columns[k]];
  double length = 0;
  for (const Edge& edge : mesh.vertical_edges) length += edge.rest_length;
  margin = kMarginShare * length / static_cast<double>(mesh.vertical_edges.size());
  pairs.reserve(16 * mesh.external_vertices.size());
  boxes.reserve(prisms.size());
  listed_at.reserve(mesh.vertexCount());
}

int resolveSelfContacts(const HairMesh& mesh, const SimParams& params, double dt, SelfContact& self, HairState& state) {
  if (!listHolds(self, state.positions)) makeList(mesh, state.positions, self);
  int inside = 0;
  const bool two_step = state.previous_positions.size() == state.positions.size();
  for (int pass = 0; pass < kPasses; ++pass) {
    int found = 0;
    for (const SelfContact::Pair& pair : self.pairs) {
      const BoundaryPrism& prism = self.prisms[pair.prism];
      const Inside where = insideOf(prism, state.positions, state.positions[pair.vertex], 0);
      if (where.face < 0) continue;
      ++found;
      const BoundaryPrism::Face& face = prism.faces[where.face];
      resolvePair(mesh, params, params.max_depenetration * dt, face, where, state, pair.vertex);
      if (!two_step) continue;
      // The history of what moved restarts, as if it had come here at its present velocity.
      const auto restart = [&](int v) {
        state.previous_positions[v] = state.positions[v] - dt * state.velocities[v];
        state.previous_velocities[v] = state.velocities[v];
      };
      restart(pair.vertex);
      for (int c = 0; c < face.corner_count; ++c) restart(face.v[c]);
    }
    inside = std::max(inside, found);
    if (found == 0) break;
  }
  return inside;
}

}  // namespace sim
