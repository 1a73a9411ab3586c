#include "app/styles/style_untangle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/styles/style_comb.h"

namespace app {

namespace relaxing {

struct Neighbours {
  std::vector<int> first{0}, list;
};

}  // namespace relaxing

namespace {

using relaxing::Neighbours;

constexpr int kSweeps = 240, kFlatSweeps = 240, kFullSweepEvery = 3;
constexpr double kShortestEdge = 0.0032;  // m: shorter ones ruin the conditioning of the simulator's systems
constexpr double kAcuteShare = 0.75;
// Above these no rounding hides a corner that is too flat or an edge that is too short: most need no square root.
constexpr double kSurelyFat = 1.15 * 1.15 * 1.000001, kSurelyLong = kShortestEdge * kShortestEdge * 1.000001;
constexpr double kLargestLift = 0.012;  // m: what that does not mend, heights do not
constexpr double kLargestMove = 0.004;  // m a sweep: large steps would throw neighbours over each other

using Corner = std::array<int, 4>;  // vertices, as CornerTet::v

template <class Visit>
void forEachCorner(const sim::RootFace& face, const sim::HairMeshShape& shape, const Visit& visit) {
  const int n = face.corner_count;
  for (int l = 0; l + 1 < shape.bundleLayers(face); ++l) {
    for (int k = 0; k < n; ++k) {
      for (const int corner : {k, n + k}) {
        Corner vertices = sim::cornerTetOf(corner, n);
        for (int& v : vertices) v = shape.column_first[face.columns[v % n]] + l + v / n;
        visit(vertices);
      }
    }
  }
}

std::vector<Corner> corners(const sim::HairMeshShape& shape) {
  std::vector<Corner> out;
  for (const sim::RootFace& face : shape.root_faces)
    forEachCorner(face, shape, [&](const Corner& vertices) { out.push_back(vertices); });
  return out;
}

// Every vertex's neighbours along its column and in its layer.
Neighbours neighbours(const sim::HairMeshShape& shape, const std::vector<Corner>& all) {
  std::vector<std::vector<int>> near(shape.positions.size());
  for (const Corner& c : all) near[c[0]].insert(near[c[0]].end(), c.begin() + 1, c.end());
  Neighbours out;
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    out.list.insert(out.list.end(), list.begin(), std::unique(list.begin(), list.end()));
    out.first.push_back(static_cast<int>(out.list.size()));
  }
  return out;
}

// Share of the fatness that a corner of a layer is asked for: acute ones would have to rise too steeply for all of it.
double squareness(const Vec3& next, const Vec3& previous) {
  const double sine = next.cross(previous).norm() / std::max(next.norm() * previous.norm(), 1e-12);
  return std::clamp(sine / 0.8, kAcuteShare, 1.0);
}

}  // namespace

// The mesh while it is relaxed. Roots do not move.
struct Untangling::Relaxation {
  const BodyDistance& body;
  const double fatness, gap;
  sim::HairMeshShape& shape;
  const std::vector<Corner> all;
  const Neighbours near;
  std::vector<bool> root;
  std::vector<Vec3> start;        // positions before the first sweep
  std::vector<Vec3> asked_at;     // where a vertex was when its distance to the body was last evaluated
  std::vector<double> clearance;  // m: that distance
  int sweeps = 0;
  bool done = false;

  Relaxation(const BodyDistance& around, double wanted, double off, sim::HairMeshShape& relaxed)
      : body(around),
        fatness(wanted),
        gap(off),
        shape(relaxed),
        all(corners(relaxed)),
        near(neighbours(relaxed, all)),
        root(relaxed.positions.size(), false) {
    for (int c = 0; c < shape.columnCount(); ++c) root[shape.column_first[c]] = true;
  }
  bool openCorner(const Corner& t);
  bool openCorners();
  bool lengthenEdges();
  void spreadMoves(double spread);
  void pushOut();
  void sweep();
};

// One Newton step of a corner's volume towards the fatness asked for, against the volume's gradient. Returns whether
// the corner was clearly below it.
bool Untangling::Relaxation::openCorner(const Corner& t) {
  std::vector<Vec3>& x = shape.positions;
  const Vec3 a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], c = x[t[3]] - x[t[0]];
  const double volume = a.cross(b).dot(c), squares = a.squaredNorm() * b.squaredNorm() * c.squaredNorm();
  // Fat enough for a square corner.
  if (volume > 0 && volume * volume > kSurelyFat * squares * fatness * fatness) return false;
  const double box = a.norm() * b.norm() * c.norm();
  if (volume >= 1.15 * fatness * box) return false;
  const double wanted = fatness * squareness(a, b), lacking = 1.15 * wanted * box - volume;
  if (lacking <= 0) return false;
  std::array<Vec3, 4> slope{Vec3::Zero(), b.cross(c), c.cross(a), a.cross(b)};
  slope[0] = -slope[1] - slope[2] - slope[3];
  double sum = 0;
  for (int k = 0; k < 4; ++k) sum += root[t[k]] ? 0.0 : slope[k].squaredNorm();
  for (int k = 0; k < 4 && sum >= 1e-24; ++k) {
    if (root[t[k]]) continue;
    Vec3 move = 0.8 * lacking / sum * slope[k];
    move *= std::min(1.0, kLargestMove / std::max(move.norm(), 1e-12));
    x[t[k]] += move;
  }
  return lacking > 0.15 * wanted * box;
}

bool Untangling::Relaxation::openCorners() {
  bool bad = false;
  for (const Corner& t : all) bad = openCorner(t) || bad;
  return bad;
}

// Moves the ends of edges that are too short apart. Returns whether one was clearly too short.
bool Untangling::Relaxation::lengthenEdges() {
  std::vector<Vec3>& x = shape.positions;
  bool bad = false;
  for (std::size_t v = 0; v < x.size(); ++v) {
    for (int i = near.first[v]; i < near.first[v + 1]; ++i) {
      const std::size_t w = near.list[i];
      if (w < v || (root[v] && root[w])) continue;
      const Vec3 edge = x[w] - x[v];
      if (edge.squaredNorm() > kSurelyLong) continue;
      const double length = edge.norm();
      if (length >= kShortestEdge) continue;
      bad = bad || length < 0.95 * kShortestEdge;
      const Vec3 direction = length > 1e-6 ? Vec3(edge / length) : Vec3((start[w] - start[v]).normalized());
      const double share = root[v] || root[w] ? 1.0 : 0.5;
      if (!root[v]) x[v] -= share * (kShortestEdge - length) * direction;
      if (!root[w]) x[w] += share * (kShortestEdge - length) * direction;
    }
  }
  return bad;
}

// Blends each vertex's move since the start with the mean of its neighbours', so that the shape stays smooth.
void Untangling::Relaxation::spreadMoves(double spread) {
  std::vector<Vec3>& x = shape.positions;
  std::vector<Vec3> moved(x.size());
  for (std::size_t v = 0; v < x.size(); ++v) {
    moved[v] = x[v] - start[v];
    if (root[v]) continue;
    Vec3 sum = Vec3::Zero();
    for (int i = near.first[v]; i < near.first[v + 1]; ++i) sum += x[near.list[i]] - start[near.list[i]];
    const int count = near.first[v + 1] - near.first[v];
    if (count > 0) moved[v] = (1 - spread) * moved[v] + spread / count * sum;
  }
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (!root[v]) x[v] = start[v] + moved[v];
  }
}

// Moves vertices closer to the body than `gap` out to it. The distance is expensive and changes by at most the move:
// it is evaluated again only where the vertex may have come near.
void Untangling::Relaxation::pushOut() {
  std::vector<Vec3>& x = shape.positions;
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (root[v] || clearance[v] - (x[v] - asked_at[v]).norm() >= gap) continue;
    clearance[v] = body(x[v]);
    asked_at[v] = x[v];
    if (clearance[v] < gap) x[v] += (gap - clearance[v]) * bodyNormal(body, x[v]);
  }
}

void Untangling::Relaxation::sweep() {
  const bool flat = openCorners(), shorter = lengthenEdges();
  if (flat || shorter) {
    // Less from sweep to sweep, so that it ends.
    spreadMoves(0.2 * (1 - static_cast<double>(sweeps) / kSweeps));
    pushOut();
  }
  done = ++sweeps == kSweeps || (!flat && !shorter);
}

double cornerFatness(const Vec3& corner, const Vec3& next, const Vec3& previous, const Vec3& along) {
  const Vec3 a = next - corner, b = previous - corner, c = along - corner;
  return a.cross(b).dot(c) / std::max(a.norm() * b.norm() * c.norm(), 1e-30);
}

// Hildreth's method: a multiplier per corner, raised while the corner is too flat and lowered while it is fatter than
// it needs to be, and the heights that follow from the multipliers.
void layFlat(const BodyDistance& body, const std::vector<Vec3>& up, double fatness, double gap,
             sim::HairMeshShape& shape) {
  std::vector<Vec3>& x = shape.positions;
  std::vector<bool> root(x.size(), false);
  for (int c = 0; c < shape.columnCount(); ++c) root[shape.column_first[c]] = true;
  const std::vector<Corner> all = corners(shape);
  std::vector<double> pressure(all.size(), 0.0), support(x.size(), 0.0), lifted(x.size(), 0.0);
  const auto lift = [&](int v, double way) {
    const double now = std::clamp(lifted[v] + way, -kLargestLift, kLargestLift);
    x[v] += (now - lifted[v]) * up[v];
    lifted[v] = now;
  };
  for (int sweep = 0; sweep < kFlatSweeps; ++sweep) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (sweep % kFullSweepEvery != 0 && pressure[i] == 0) continue;
      const Corner& t = all[i];
      const Vec3 a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], c = x[t[3]] - x[t[0]];
      const double box = std::max(a.norm() * b.norm() * c.norm(), 1e-12);
      std::array<Vec3, 4> slope{Vec3::Zero(), b.cross(c), c.cross(a), a.cross(b)};
      slope[0] = -slope[1] - slope[2] - slope[3];
      std::array<double, 4> rise{};
      double sum = 0;
      for (int k = 0; k < 4; ++k) {
        rise[k] = root[t[k]] ? 0.0 : slope[k].dot(up[t[k]]) / box;
        sum += rise[k] * rise[k];
      }
      if (sum < 1e-12) continue;
      const double lacking = fatness * squareness(a, b) - a.cross(b).dot(c) / box;
      const double change = std::max(-pressure[i], lacking / sum);
      pressure[i] += change;
      for (int k = 0; k < 4; ++k)
        if (!root[t[k]]) lift(t[k], change * rise[k]);
    }
    for (std::size_t v = 0; v < x.size() && sweep % 10 == 9; ++v) {
      if (root[v]) continue;
      const double change = std::max(-support[v], gap - body(x[v]));
      support[v] += change;
      lift(static_cast<int>(v), change);
    }
  }
}

double flattestOf(const sim::RootFace& face, const sim::HairMeshShape& shape) {
  double least = 1;
  forEachCorner(face, shape, [&](const Corner& t) {
    const std::vector<Vec3>& x = shape.positions;
    least = std::min(least, cornerFatness(x[t[0]], x[t[1]], x[t[2]], x[t[3]]));
  });
  return least;
}

Untangling::Untangling(const BodyDistance& body, double fatness, double gap, sim::HairMeshShape& shape)
    : relaxation_(std::make_unique<Relaxation>(body, fatness, gap, shape)) {
  begin();
}
Untangling::~Untangling() = default;

void Untangling::begin() {
  Relaxation& relaxation = *relaxation_;
  relaxation.start = relaxation.asked_at = relaxation.shape.positions;
  relaxation.clearance.assign(relaxation.start.size(), -1e9);
  relaxation.sweeps = 0;
  relaxation.done = false;
}

int Untangling::work(int sweeps) {
  int made = 0;
  for (; made < sweeps && !done(); ++made) relaxation_->sweep();
  return made;
}

bool Untangling::done() const {
  return relaxation_->done;
}

double Untangling::flattest() const {
  double least = 1;
  for (const sim::RootFace& face : relaxation_->shape.root_faces)
    least = std::min(least, flattestOf(face, relaxation_->shape));
  return least;
}

double untangle(const BodyDistance& body, double fatness, double gap, sim::HairMeshShape& shape) {
  Untangling untangling(body, fatness, gap, shape);
  untangling.work(kSweeps);
  return untangling.flattest();
}

}  // namespace app
