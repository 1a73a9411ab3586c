#include "sim/comb_out.h"

#include <algorithm>
#include <cmath>

#include "sim/watchdog.h"

namespace sim {
namespace {

constexpr double kLookEvery = 0.1;      // s
constexpr double kTurnedOver = -0.05;   // of the rest volume: beyond being flat
constexpr double kSqueezed = 0.5;       // of the rest volume, where the hair hangs still: wound around its neighbours
constexpr double kStill = 0.02;         // m/s against the root
constexpr double kFolded = -0.5;        // cosine between a column's segments, where at rest it is above zero
constexpr double kCombing = 0.4;        // s
constexpr double kSoon = 1e-3;          // s before the end that count as the end
constexpr double kFirstPatience = 0.5;  // s
constexpr double kMostPatience = 600;   // s
// A storm may hold hair turned over for good, and is not to be combed against.
constexpr double kPatienceGrows = 4;
constexpr double kForgiven = 10;  // s upright after which a column's patience begins anew

double volumeOf(const CornerTet& tet, const std::vector<Vec3>& x) {
  const Vec3& o = x[tet.v[0]];
  return (x[tet.v[1]] - o).dot((x[tet.v[2]] - o).cross(x[tet.v[3]] - o)) / 6;
}

double cosineAt(const int (&segment)[3], const std::vector<Vec3>& x) {
  const Vec3 lower = x[segment[1]] - x[segment[0]], upper = x[segment[2]] - x[segment[1]];
  const double lengths = std::sqrt(lower.squaredNorm() * upper.squaredNorm());
  return lengths > 0 ? lower.dot(upper) / lengths : 0;
}

// Returns whether it does: one that is being combed, or has to wait, goes on with that.
bool begin(Tangles::Column& column) {
  if (column.combed >= 0 || column.wait > 0) return false;
  column.combed = 0;
  column.patience = std::min(kMostPatience, std::max(kFirstPatience, kPatienceGrows * column.patience));
  column.wait = kCombing + column.patience;
  return true;
}

void look(const HairMesh& mesh, const HairState& state, double seconds, Tangles& tangles) {
  for (Tangles::Column& column : tangles.columns) {
    column.wait = std::max(0.0, column.wait - seconds);
    column.upright += seconds;
    if (column.upright > kForgiven) column.patience = 0;
  }
  std::fill(tangles.touched.begin(), tangles.touched.end(), char{0});
  for (const Contact& contact : state.contacts) tangles.touched[contact.vertex] = 1;
  // Counts how long something has been tangled, and has its columns combed when it has been long enough.
  const auto count = [&](bool tangled, bool again, std::span<const int> vertices, double& lasted) {
    lasted = tangled ? lasted + seconds : 0;
    if (!tangled) return;
    for (const int v : vertices) tangles.columns[mesh.column_of[v]].upright = 0;
    if (lasted < kTurnedFor) return;
    if (std::any_of(vertices.begin(), vertices.end(), [&](int v) { return tangles.touched[v] != 0; })) return;
    for (const int v : vertices) {
      Tangles::Column& column = tangles.columns[mesh.column_of[v]];
      if ((!again && column.patience > 0) || !begin(column)) continue;
      const int c = mesh.column_of[v];
      for (int i = mesh.shape.column_first[c]; i < mesh.shape.column_first[c + 1]; ++i)
        tangles.target[i] = mesh.shape.positions[i];
    }
  };
  const auto still = [&](int v) {
    const Vec3& root = state.velocities[mesh.shape.column_first[mesh.column_of[v]]];
    return (state.velocities[v] - root).squaredNorm() < kStill * kStill;
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const CornerTet& tet = mesh.tets[t];
    const double share = volumeOf(tet, state.positions) / tet.rest_volume;
    const bool wound = share < kSqueezed && std::all_of(tet.v.begin(), tet.v.end(), still);
    // Very soft hair rests squeezed: once combed it is left so.
    count(share < kTurnedOver || wound, share < kTurnedOver, tet.v, tangles.turned[t]);
  }
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (mesh.layer_of[i] < 2) continue;
    const int segment[] = {i - 2, i - 1, i};
    const bool folds = cosineAt(segment, state.positions) < kFolded && cosineAt(segment, mesh.shape.positions) > 0;
    count(folds, true, segment, tangles.folded[i]);
  }
}

// The share of the way that is left so many seconds after the beginning.
double left(double seconds) {
  const double s = seconds / kCombing;
  return 1 - s * s * (3 - 2 * s);
}

}  // namespace

Tangles::Tangles(const HairMesh& mesh) {
  columns.resize(mesh.columnCount());
  turned.resize(mesh.tets.size());
  folded.resize(mesh.vertexCount());
  touched.resize(mesh.vertexCount());
  for (int c = 0; c < mesh.columnCount(); ++c) rest_roots.push_back(mesh.shape.positions[mesh.shape.column_first[c]]);
  roots_before = roots_now = rest_roots;
  target = mesh.shape.positions;
}

void leadTo(const HairMesh& mesh, const HairState& there, Tangles& tangles) {
  for (int c = 0; c < mesh.columnCount(); ++c) tangles.roots_now[c] = there.positions[mesh.shape.column_first[c]];
  const Eigen::Isometry3d home = rigidMotion(tangles.rest_roots, tangles.roots_now).inverse();
  for (int c = 0; c < mesh.columnCount(); ++c) {
    Tangles::Column& column = tangles.columns[c];
    if (column.combed < 0) ++tangles.combing;
    column.combed = 0;
    for (int i = mesh.shape.column_first[c]; i < mesh.shape.column_first[c + 1]; ++i)
      tangles.target[i] = home * there.positions[i];
  }
}

int combOut(const CombedStep& step, Tangles& tangles, HairState& state) {
  const HairMesh& mesh = step.mesh;
  tangles.since_look += step.dt;
  if (tangles.since_look >= kLookEvery) {
    if (step.looks) look(mesh, state, tangles.since_look, tangles);
    tangles.since_look = 0;
    tangles.combing = static_cast<int>(
        std::count_if(tangles.columns.begin(), tangles.columns.end(), [](const auto& c) { return c.combed >= 0; }));
  }
  if (tangles.combing == 0) return 0;
  for (int c = 0; c < mesh.columnCount(); ++c) {
    tangles.roots_before[c] = step.start[mesh.shape.column_first[c]];
    tangles.roots_now[c] = state.positions[mesh.shape.column_first[c]];
  }
  const Eigen::Isometry3d before = rigidMotion(tangles.rest_roots, tangles.roots_before).inverse();
  const Eigen::Isometry3d now = rigidMotion(tangles.rest_roots, tangles.roots_now);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    Tangles::Column& column = tangles.columns[c];
    if (column.combed < 0) continue;
    const bool arrives = column.combed + step.dt > kCombing - kSoon;
    const double share = arrives ? 0 : left(column.combed + step.dt) / left(column.combed);
    for (int i = mesh.shape.column_first[c] + 1; i < mesh.shape.column_first[c + 1]; ++i) {
      const Vec3& rest = tangles.target[i];
      state.positions[i] = now * (rest + share * (before * step.start[i] - rest));
      state.velocities[i] = (state.positions[i] - step.start[i]) / step.dt;
    }
    column.combed = arrives ? -1 : column.combed + step.dt;
  }
  state.previous_dt = 0;  // what came before says nothing any more about how it goes on
  return tangles.combing;
}

}  // namespace sim
