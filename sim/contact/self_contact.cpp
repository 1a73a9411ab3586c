#include "sim/contact/self_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace sim {
namespace {

constexpr double kMarginShare = 0.25;   // of the mean length of the edges along the hair
constexpr double kRestMargin = 0.002;   // m; pairs as near as this in the rest shape are no contacts
constexpr int kMaxPasses = 8;           // over the pairs: one push may press others together
constexpr int kMaxPiecePasses = 2;      // the same, after one piece of the step's motion
constexpr int kOwnLayers = 1;           // a column is tested with prisms of its own bundles beyond so many layers
constexpr double kStrideShare = 0.125;  // of the mean length of the edges across: longest piece of a path
constexpr int kMaxPieces = 32;
constexpr signed char kOverlapsAtRest = -1;  // in place of Pair::apart

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

// Whether p lies outside the mean plane of a face, or the face has none.
bool beyond(const BoundaryPrism::Face& face, std::span<const Vec3> x, const Vec3& p) {
  const Plane plane = planeOf(face, x);
  return !(plane.normal.dot(plane.middle - p) >= 0);
}

// Where p lies in a prism: inside all of its faces' mean planes, or outside by no more than the margin (m). A prism
// that is inverted or flat has no inside.
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

// The same for a pair of the list. The face that the vertex last lay beyond is tested first: most still do.
Inside insideOf(const HairMesh& mesh, SelfContact& self, SelfContact::Pair& pair, std::span<const Vec3> x) {
  if (pair.apart == kOverlapsAtRest) return {};
  const BoundaryPrism& prism = self.prisms[pair.prism];
  const Vec3& p = x[pair.vertex];
  if (beyond(prism.faces[pair.apart], x, p)) return {};
  for (int f = 0; f < prism.face_count; ++f) {
    if (f == pair.apart || !beyond(prism.faces[f], x, p)) continue;
    pair.apart = static_cast<signed char>(f);
    return {};
  }
  const Inside inside = insideOf(prism, x, p, 0);
  if (inside.face < 0) return {};
  const std::vector<Vec3>& rest = mesh.shape.positions;
  if (insideOf(prism, rest, rest[pair.vertex], kRestMargin).face < 0) return inside;
  pair.apart = kOverlapsAtRest;
  return {};
}

// Weights of a face's corners at p: barycentric in the triangle of the face that p lies over.
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

// Whether every vertex has moved by less than half the list's margin, at the step's start and at its end.
bool listHolds(const SelfContact& self, std::span<const Vec3> start, std::span<const Vec3> x) {
  if (self.listed_at.empty()) return false;
  const double most = self.margin * self.margin / 4;
  for (const std::span<const Vec3> at : {start, x}) {
    const Frame frame = scalpFrame(self, at);
    for (std::size_t i = 0; i < at.size(); ++i) {
      // Negated, so that a position that is not finite makes a new list.
      if (!((frame.axes * (at[i] - frame.origin) - self.listed_at[i]).squaredNorm() < most)) return false;
    }
    if (start.data() == x.data()) break;
  }
  return true;
}

// m, the longest way of a vertex within the step relative to a corner of its pair's prism.
double farthestNearing(const HairMesh& mesh, const SelfContact& self, std::span<const Vec3> start,
                       std::span<const Vec3> x) {
  double most = 0;
  for (const SelfContact::Pair& pair : self.pairs) {
    const int corner = mesh.prisms[self.prisms[pair.prism].prism].v[0];
    const Vec3 nearing = x[pair.vertex] - start[pair.vertex] - (x[corner] - start[corner]);
    most = std::max(most, nearing.squaredNorm());
  }
  return std::sqrt(most);
}

// Whether a vertex of this layer is too near to a prism of its own bundles, along the hair, to be tested with it.
bool alongside(int layer, const Prism& prism) {
  return layer >= prism.layer - kOwnLayers && layer <= prism.layer + 1 + kOwnLayers;
}

// Sweep and prune along y, in which hair is longest. Boxes bound the paths from start to end.
void makeList(const HairMesh& mesh, std::span<const Vec3> start, std::span<const Vec3> x, SelfContact& self) {
  ++self.rebuilds;
  self.made_for.start.assign(start.begin(), start.end());
  self.made_for.end.assign(x.begin(), x.end());
  self.pairs.clear();
  const Frame frame = scalpFrame(self, x);
  self.listed_at.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) self.listed_at[i] = frame.axes * (x[i] - frame.origin);
  self.boxes.resize(self.prisms.size());
  double tallest = 0;
  for (std::size_t k = 0; k < self.prisms.size(); ++k) {
    const Prism& prism = mesh.prisms[self.prisms[k].prism];
    Vec3 low = x[prism.v[0]], high = low;
    for (int c = 0; c < 2 * prism.corner_count; ++c) {
      const Vec3 &from = start[prism.v[c]], &to = x[prism.v[c]];
      low = low.cwiseMin(from).cwiseMin(to), high = high.cwiseMax(from).cwiseMax(to);
    }
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
    const Vec3 low = x[v].cwiseMin(start[v]), high = x[v].cwiseMax(start[v]);
    auto box = std::lower_bound(self.boxes.begin(), self.boxes.end(), low.y() - tallest,
                                [](const auto& b, double y) { return b.low.y() < y; });
    for (; box != self.boxes.end() && box->low.y() <= high.y(); ++box) {
      if (!((high.array() >= box->low.array()).all() && (low.array() <= box->high.array()).all())) continue;
      const BoundaryPrism& prism = self.prisms[box->prism];
      const Prism& source = mesh.prisms[prism.prism];
      if (own[source.root_face] && alongside(mesh.layer_of[v], source)) continue;
      self.pairs.push_back({v, box->prism, 0, false});
    }
    std::sort(self.pairs.begin() + first, self.pairs.end(),
              [](const auto& a, const auto& b) { return a.prism < b.prism; });
  }
}

// Makes the list that the state remembers, where `self` has another one.
void recallList(const HairMesh& mesh, const SelfContactMemory& memory, SelfContact& self) {
  if (memory.start == self.made_for.start && memory.end == self.made_for.end) return;
  if (!memory.end.empty()) return makeList(mesh, memory.start, memory.end, self);
  self.made_for.start.clear(), self.made_for.end.clear();
  self.listed_at.clear();
}

// A vertex and a face in contact: the share of an impulse that each takes, by mass over density. Roots do not move.
struct Partners {
  int vertex;
  const BoundaryPrism::Face* face;
  std::array<double, 4> weight, give{};
  double yield, sum;

  Partners(const HairMesh& mesh, const BoundaryPrism::Face& f, std::span<const Vec3> x, int v)
      : vertex(v), face(&f), weight(cornerWeights(f, x, x[v])), yield(1 / mesh.vertex_volume[v]), sum(yield) {
    for (int c = 0; c < f.corner_count; ++c) {
      give[c] = mesh.isRoot(f.v[c]) ? 0 : weight[c] / mesh.vertex_volume[f.v[c]];
      sum += weight[c] * give[c];
    }
  }

  // Changes the difference between vertex and face by `change`.
  void apply(const Vec3& change, std::span<Vec3> of) const {
    of[vertex] += yield / sum * change;
    for (int c = 0; c < face->corner_count; ++c) of[face->v[c]] -= give[c] / sum * change;
  }

  // Removes the approach from velocities or displacements, and from the slip what friction does.
  void stop(const Vec3& normal, double friction, std::span<Vec3> of) const {
    Vec3 relative = of[vertex];
    for (int c = 0; c < face->corner_count; ++c) relative -= weight[c] * of[face->v[c]];
    const double approach = std::max(0.0, -relative.dot(normal));
    const Vec3 slip = relative - relative.dot(normal) * normal;
    const double speed = slip.norm(), loss = std::min(speed, friction * approach);
    Vec3 change = approach * normal;
    if (speed > 0) change -= loss / speed * slip;
    apply(change, of);
  }
};

// Pushes penetrating pairs apart, pass by pass. `way`: displacements of the next piece of the motion, or empty. Returns
// the largest number of penetrating pairs in a pass.
int resolvePairs(const SelfContactStep& step, int passes, std::span<Vec3> way, SelfContact& self, HairState& state) {
  int inside = 0;
  const bool two_step = state.previous_positions.size() == state.positions.size();
  const double escape = step.params.max_depenetration * step.dt / (way.empty() ? 1 : self.pieces);
  for (int pass = 0; pass < passes; ++pass) {
    int found = 0;
    for (SelfContact::Pair& pair : self.pairs) {
      const Inside where = insideOf(step.mesh, self, pair, state.positions);
      if (where.face < 0) continue;
      ++found;
      const BoundaryPrism::Face& face = self.prisms[pair.prism].faces[where.face];
      self.moved[pair.vertex] = 1;
      for (int c = 0; c < face.corner_count; ++c) self.moved[face.v[c]] = 1;
      const Partners partners(step.mesh, face, state.positions, pair.vertex);
      partners.apply((pair.stood ? std::min(where.depth, escape) : where.depth) * where.normal, state.positions);
      partners.stop(where.normal, step.params.friction, state.velocities);
      if (!way.empty()) partners.stop(where.normal, step.params.friction, way);
      if (!two_step) continue;
      state.restartHistory(pair.vertex, step.dt);
      for (int c = 0; c < face.corner_count; ++c) state.restartHistory(face.v[c], step.dt);
    }
    inside = std::max(inside, found);
    if (found == 0) break;
  }
  return inside;
}

// The number of pieces of the way from start to end after which a pair that was apart first penetrates, or, after all
// of them, any pair; negative: none.
int firstMeeting(const HairMesh& mesh, std::span<const Vec3> start, std::span<const Vec3> x, SelfContact& self) {
  self.between.resize(x.size());
  bool known = false;  // which pairs overlapped before the step
  const auto findOverlaps = [&] {
    for (SelfContact::Pair& pair : self.pairs) pair.stood = insideOf(mesh, self, pair, start).face >= 0;
    known = true;
  };
  for (int piece = 1; piece < self.pieces; ++piece) {
    const double t = static_cast<double>(piece) / self.pieces;
    for (std::size_t i = 0; i < x.size(); ++i) self.between[i] = start[i] + t * (x[i] - start[i]);
    for (SelfContact::Pair& pair : self.pairs) {
      if (insideOf(mesh, self, pair, self.between).face < 0) continue;
      if (!known) findOverlaps();
      if (!pair.stood) return piece;
    }
  }
  for (SelfContact::Pair& pair : self.pairs) {
    if (insideOf(mesh, self, pair, x).face < 0) continue;
    if (!known) findOverlaps();
    return std::max(self.pieces, 1);
  }
  return -1;
}

// Repeats the step's motion from the first meeting on in pieces too short to pass through a prism; vertices that meet
// go on without their approach. `between`: the positions of the first meeting.
int replay(const SelfContactStep& step, int meeting, SelfContact& self, HairState& state) {
  const std::size_t n = state.positions.size();
  self.way.resize(n);
  for (std::size_t i = 0; i < n; ++i) self.way[i] = (state.positions[i] - step.start[i]) / self.pieces;
  std::copy(self.between.begin(), self.between.end(), state.positions.begin());
  int inside = 0;
  for (int piece = meeting;; ++piece) {
    inside = std::max(inside, resolvePairs(step, kMaxPiecePasses, self.way, self, state));
    if (piece == self.pieces) break;
    for (std::size_t i = 0; i < n; ++i) state.positions[i] += self.way[i];
  }
  // Summed ways round: roots are prescribed to the last bit.
  for (int c = 0; c < step.mesh.columnCount(); ++c) {
    const int root = step.mesh.shape.column_first[c];
    state.positions[root] = self.unmoved[root];
  }
  return inside;
}

// The prisms with a face on the outside. Lower and upper face come first: their middles' mean is the prism's centre.
std::vector<BoundaryPrism> boundaryPrisms(const HairMesh& mesh) {
  const auto key = [](int count, std::array<int, 4> v) {
    if (count == 3) v[3] = -1;
    std::sort(v.begin(), v.end());
    return v;
  };
  std::set<std::array<int, 4>> outer;
  for (const ExternalFace& face : mesh.external_faces) outer.insert(key(face.corner_count, face.v));
  std::vector<BoundaryPrism> prisms;
  for (int p = 0; p < static_cast<int>(mesh.prisms.size()); ++p) {
    const auto& v = mesh.prisms[p].v;
    const int n = mesh.prisms[p].corner_count;
    BoundaryPrism boundary{p, n + 2, {}};
    boundary.faces[0] = {n, {v[0], v[n - 1], v[n - 2], n == 4 ? v[1] : -1}, false};
    boundary.faces[1] = {n, {v[n], v[n + 1], v[n + 2], n == 4 ? v[n + 3] : -1}, false};
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n;
      boundary.faces[2 + k] = {4, {v[k], v[next], v[n + next], v[n + k]}, false};
    }
    bool any = false;
    for (int f = 1; f < boundary.face_count; ++f) {
      boundary.faces[f].external = outer.contains(key(boundary.faces[f].corner_count, boundary.faces[f].v));
      any = any || boundary.faces[f].external;
    }
    if (any) prisms.push_back(boundary);
  }
  return prisms;
}

// SelfContact::own of a mesh.
std::vector<unsigned char> ownBundles(const HairMesh& mesh) {
  const auto& faces = mesh.shape.root_faces;
  std::vector<std::set<int>> around(mesh.columnCount());  // columns that share a root face
  for (const RootFace& face : faces) {
    for (int i = 0; i < face.corner_count; ++i)
      for (int k = 0; k < face.corner_count; ++k) around[face.columns[i]].insert(face.columns[k]);
  }
  std::vector<unsigned char> own(mesh.columnCount() * faces.size(), 0);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (int k = 0; k < faces[f].corner_count; ++k)
        own[c * faces.size() + f] |= around[c].contains(faces[f].columns[k]) ? 1 : 0;
    }
  }
  return own;
}

// Three roots far from one another, so that the frame is exact.
std::array<int, 3> frameRoots(const HairMesh& mesh) {
  const auto root = [&](int c) { return mesh.shape.positions[mesh.shape.column_first[c]]; };
  std::array<int, 3> columns{0, 0, 0};
  for (int c = 1; c < mesh.columnCount(); ++c) {
    if ((root(c) - root(0)).norm() > (root(columns[1]) - root(0)).norm()) columns[1] = c;
  }
  const auto area = [&](int c) { return (root(columns[1]) - root(0)).cross(root(c) - root(0)).norm(); };
  for (int c = 1; c < mesh.columnCount(); ++c) {
    if (area(c) > area(columns[2])) columns[2] = c;
  }
  for (int& c : columns) c = mesh.shape.column_first[c];
  return columns;
}

double meanLength(const std::vector<Edge>& edges) {
  double sum = 0;
  for (const Edge& edge : edges) sum += edge.rest_length;
  return sum / static_cast<double>(edges.size());
}

}  // namespace

SelfContact::SelfContact(const HairMesh& mesh)
    : prisms(boundaryPrisms(mesh)),
      own(ownBundles(mesh)),
      frame_roots(frameRoots(mesh)),
      margin(kMarginShare * meanLength(mesh.vertical_edges)),
      stride(kStrideShare * meanLength(mesh.horizontal_edges)) {
  pairs.reserve(32 * mesh.external_vertices.size());
  boxes.reserve(prisms.size());
  for (auto* field : {&made_for.start, &made_for.end, &listed_at, &unmoved, &between, &way})
    field->reserve(mesh.vertexCount());
  moved.reserve(mesh.vertexCount());
}

int resolveSelfContacts(const SelfContactStep& step, SelfContact& self, HairState& state) {
  const std::span<const Vec3> start = step.start.empty() ? std::span<const Vec3>(state.positions) : step.start;
  recallList(step.mesh, state.memory.self_contact, self);
  if (!listHolds(self, start, state.positions)) {
    makeList(step.mesh, start, state.positions, self);
    state.memory.self_contact = self.made_for;
  }
  const double nearing = farthestNearing(step.mesh, self, start, state.positions);
  self.pieces = static_cast<int>(std::min<double>(kMaxPieces, std::ceil(nearing / self.stride)));
  const int meeting = firstMeeting(step.mesh, start, state.positions, self);
  if (meeting < 0) return 0;
  self.unmoved = state.positions;
  self.moved.assign(state.positions.size(), 0);
  const int met = meeting < self.pieces ? replay(step, meeting, self, state) : 0;
  return std::max(met, resolvePairs(step, kMaxPasses, {}, self, state));
}

}  // namespace sim
