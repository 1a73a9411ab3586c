#include "sim/stabilization/inversion_recovery.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rigid_motion.h"

namespace sim {
namespace {

constexpr double kLookEvery = 0.1;           // s
constexpr double kInvertedShare = -0.05;     // of the rest volume: beyond flat
constexpr double kSqueezed = 0.5;            // of the rest volume, of tetrahedra at rest: wound around their neighbours
constexpr char kTouched = 1, kTied = 2;      // a vertex in contact; a root whose column a firm pin holds
constexpr double kStillColumn = 0.02;        // m/s against the root
constexpr double kFolded = -0.5;             // cosine between a column's segments, where at rest it is above zero
constexpr double kGuideTime = 0.4;           // s
constexpr double kSoon = 1e-3;               // s before the end that count as the end
constexpr double kFirstColumnBackoff = 0.5;  // s
constexpr double kMaxColumnBackoff = 600;    // s
constexpr double kColumnBackoffGrowth = 4;   // strong wind may hold hair inverted for good
constexpr double kForgiven = 10;             // s upright after which a column's backoff begins anew

double volumeOf(const CornerTet& tet, const std::vector<Vec3>& x) {
  const Vec3& o = x[tet.v[0]];
  return (x[tet.v[1]] - o).dot((x[tet.v[2]] - o).cross(x[tet.v[3]] - o)) / 6;
}

double cosineAt(const int (&segment)[3], const std::vector<Vec3>& x) {
  const Vec3 lower = x[segment[1]] - x[segment[0]], upper = x[segment[2]] - x[segment[1]];
  const double lengths = std::sqrt(lower.squaredNorm() * upper.squaredNorm());
  return lengths > 0 ? lower.dot(upper) / lengths : 0;
}

// Returns whether it does: not while the column is guided or waits.
bool begin(RecoveryMemory::Column& column) {
  if (column.guided >= 0 || column.wait > 0) return false;
  column.guided = 0;
  column.backoff = std::min(kMaxColumnBackoff, std::max(kFirstColumnBackoff, kColumnBackoffGrowth * column.backoff));
  column.wait = kGuideTime + column.backoff;
  return true;
}

void look(const RecoveredStep& step, double seconds, std::vector<char>& touched, HairState& state) {
  const HairMesh& mesh = step.mesh;
  RecoveryMemory& recovery = state.memory.recovery;
  for (RecoveryMemory::Column& column : recovery.columns) {
    column.wait = std::max(0.0, column.wait - seconds);
    column.upright += seconds;
    if (column.upright > kForgiven) column.backoff = 0;
  }
  touched.assign(mesh.vertexCount(), 0);
  const auto rootOf = [&](int v) { return mesh.shape.column_first[mesh.column_of[v]]; };
  for (const PinnedVertex& pin : step.pins) touched[rootOf(pin.vertex)] |= pin.firm() ? kTied : 0;
  for (const Contact& contact : state.contacts) touched[contact.vertex] |= kTouched;
  // With all of its column: near the roots nothing moves fast while the hair above is on its way home.
  const auto rests = [&](int v) {
    const auto root = state.velocities.begin() + rootOf(v);
    const auto still = [&](const Vec3& u) { return (u - *root).squaredNorm() < kStillColumn * kStillColumn; };
    return std::all_of(root, root + mesh.shape.columnLength(mesh.column_of[v]), still);
  };
  // Counts how long an element has been inverted, and guides its columns when it has been long enough.
  const auto count = [&](bool inverted, bool again, std::span<const int> vertices, double& lasted) {
    const bool at_rest = inverted && std::all_of(vertices.begin(), vertices.end(), rests);
    lasted = inverted ? lasted + (at_rest ? kRestWeight : 1) * seconds : 0;
    if (!inverted) return;
    for (const int v : vertices) recovery.columns[mesh.column_of[v]].upright = 0;
    const auto guided = [&](int v) { return recovery.columns[mesh.column_of[v]].guided >= 0; };
    if (lasted < kInvertedFor && std::none_of(vertices.begin(), vertices.end(), guided)) return;
    if (std::any_of(vertices.begin(), vertices.end(), [&](int v) { return (touched[v] & kTouched) != 0; })) return;
    for (const int v : vertices) {
      RecoveryMemory::Column& column = recovery.columns[mesh.column_of[v]];
      if ((!again && column.backoff > 0) || !begin(column)) continue;
      const int c = mesh.column_of[v];
      for (int i = mesh.shape.column_first[c]; i < mesh.shape.column_first[c + 1]; ++i)
        recovery.target[i] = mesh.shape.positions[i];
    }
  };
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const CornerTet& tet = mesh.tets[t];
    const double share = volumeOf(tet, state.positions) / tet.rest_volume;
    const auto slack = [&](int v) { return (touched[rootOf(v)] & kTied) == 0 && rests(v); };
    const bool squeezed = share < kSqueezed && std::all_of(tet.v.begin(), tet.v.end(), slack);
    // Very soft hair rests squeezed: guided once, it is left so.
    count(share < kInvertedShare || squeezed, share < kInvertedShare, tet.v, recovery.turned[t]);
  }
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    if (mesh.layer_of[i] < 2) continue;
    const int segment[] = {i - 2, i - 1, i};
    const bool folds = cosineAt(segment, state.positions) < kFolded && cosineAt(segment, mesh.shape.positions) > 0;
    count(folds, true, segment, recovery.folded[i]);
  }
}

// The share of the way that is left so many seconds after the beginning.
double left(double seconds) {
  const double s = seconds / kGuideTime;
  return 1 - s * s * (3 - 2 * s);
}

}  // namespace

void guideTo(const HairMesh& mesh, const HairState& there, RecoveryMemory& recovery) {
  const Eigen::Isometry3d home = rootMotion(mesh, there.positions, mesh.shape.positions);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    RecoveryMemory::Column& column = recovery.columns[c];
    if (column.guided < 0) ++recovery.guided_columns;
    column.guided = 0;
    for (int i = mesh.shape.column_first[c]; i < mesh.shape.column_first[c + 1]; ++i)
      recovery.target[i] = home * there.positions[i];
  }
}

int recoverInversions(const RecoveredStep& step, std::vector<char>& touched, HairState& state) {
  const HairMesh& mesh = step.mesh;
  RecoveryMemory& recovery = state.memory.recovery;
  recovery.since_look += step.dt;
  if (recovery.since_look >= kLookEvery) {
    if (step.looks) look(step, recovery.since_look, touched, state);
    recovery.since_look = 0;
    recovery.guided_columns = static_cast<int>(
        std::count_if(recovery.columns.begin(), recovery.columns.end(), [](const auto& c) { return c.guided >= 0; }));
  }
  if (recovery.guided_columns == 0) return 0;
  const Eigen::Isometry3d before = rootMotion(mesh, step.start, mesh.shape.positions);
  const Eigen::Isometry3d now = rootMotion(mesh, mesh.shape.positions, state.positions);
  for (int c = 0; c < mesh.columnCount(); ++c) {
    RecoveryMemory::Column& column = recovery.columns[c];
    if (column.guided < 0) continue;
    const bool arrives = column.guided + step.dt > kGuideTime - kSoon;
    const double share = arrives ? 0 : left(column.guided + step.dt) / left(column.guided);
    for (int i = mesh.shape.column_first[c] + 1; i < mesh.shape.column_first[c + 1]; ++i) {
      const Vec3& rest = recovery.target[i];
      state.positions[i] = now * (rest + share * (before * step.start[i] - rest));
      state.velocities[i] = (state.positions[i] - step.start[i]) / step.dt;
    }
    column.guided = arrives ? -1 : column.guided + step.dt;
  }
  state.previous_dt = 0;  // what came before says nothing any more about how it goes on
  return recovery.guided_columns;
}

}  // namespace sim
