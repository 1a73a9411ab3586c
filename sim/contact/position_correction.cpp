#include "sim/contact/position_correction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sim {
namespace {

constexpr int kRounds = 4;               // of position correction and deformation minimization
constexpr int kPlainRounds = 8;          // more of correction alone
constexpr double kMaxPoints = 1.5;       // closest points of colliders, a vertex and step
constexpr int kMaxMinimizations = 12;    // iterations of deformation minimization, a step
constexpr int kExactCost = 2;            // of them, that an exact solution stands for
constexpr double kMinimization = 1e-3;   // relative residual
constexpr double kFastestFollower = 10;  // m/s that a vertex takes from following a corrected one

// A corrected vertex takes the collider's normal velocity and loses tangential speed to friction. The contact
// constrains the next solve.
void enterContact(const CorrectedStep& step, const Penetration& hit, HairState& state) {
  const Ellipsoid& body = step.colliders.body(hit.collider);
  Vec3& v = state.velocities[hit.vertex];
  const Vec3 relative = v - surfaceVelocity(body, hit.target);
  const double approach = -relative.dot(hit.normal);
  if (approach > 0) {
    const Vec3 slip = relative + approach * hit.normal;
    const double speed = slip.norm();
    const double loss = std::min(speed, step.params.friction * approach);
    v += approach * hit.normal;
    if (speed > 0) v -= slip * (loss / speed);
  }
  const bool known = std::ranges::any_of(
      state.contacts, [&](const Contact& c) { return c.vertex == hit.vertex && c.collider == hit.collider; });
  if (!known) state.contacts.push_back({.vertex = hit.vertex, .collider = hit.collider, .normal = hit.normal});
}

// Moves the vertices found to the surface. Returns their number.
int correctFound(const CorrectedStep& step, double slack, PositionCorrection& scratch, HairState& state) {
  scratch.corrected.clear();
  for (const Penetration& hit : scratch.penetrations) {
    if (hit.depth > slack || hit.initial_overlap) {
      scratch.displacement[hit.vertex] = hit.target - state.positions[hit.vertex];
      scratch.held[hit.vertex] = 1;
      state.positions[hit.vertex] = hit.target;
      if (scratch.corrected.empty() || scratch.corrected.back() != hit.vertex) scratch.corrected.push_back(hit.vertex);
    }
    enterContact(step, hit, state);
  }
  return static_cast<int>(scratch.corrected.size());
}

// m/s: the deepest penetration by the step's own motion, initial overlaps left out, over the step.
double correctionSpeed(const CorrectedStep& step, const PositionCorrection& scratch) {
  double most = 0;
  for (const Penetration& hit : scratch.penetrations) {
    if (!hit.initial_overlap) most = std::max(most, hit.depth);
  }
  return std::min(most / step.dt, kFastestFollower);
}

// Roots and vertices in contact do not follow.
void holdResting(const HairMesh& mesh, const HairState& state, PositionCorrection& scratch) {
  for (int c = 0; c < mesh.columnCount(); ++c) scratch.held[mesh.shape.column_first[c]] = 1;
  for (const Contact& contact : state.contacts) scratch.held[contact.vertex] = 1;
}

// The others follow those held. Returns the work (StepReport::minimization_iterations).
int letFollow(PositionCorrection& scratch, HairState& state) {
  const int most = scratch.max_minimizations - scratch.minimizations;
  if (most <= 0) return 0;
  const int work = scratch.minimizer.minimize(scratch.held, kMinimization, scratch.displacement, most);
  // Not the paths computed: what is cached changes no result, so it must not change what comes next.
  scratch.minimizations += scratch.minimizer.iterated() ? work : kExactCost;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (!scratch.held[i]) state.positions[i] += scratch.displacement[i];
  }
  return work;
}

// Vertices that followed take the velocity of their displacement, bounded by `most` (m/s): resolving an initial overlap
// must not kick them. Restarts the two-step history of all that moved.
void followCorrections(const CorrectedStep& step, double most, const PositionCorrection& scratch, HairState& state) {
  for (int i = 0; i < step.mesh.vertexCount(); ++i) {
    if (step.mesh.isRoot(i)) continue;
    const Vec3 moved = state.positions[i] - scratch.uncorrected[i];
    const double speed = moved.norm() / step.dt;
    if (speed <= 0) continue;
    if (!scratch.held[i]) state.velocities[i] += moved * (std::min(speed, most) / (speed * step.dt));
    state.restartHistory(i, step.dt);
  }
}

}  // namespace

PositionCorrection::PositionCorrection(const HairMesh& mesh) : minimizer(mesh) {
  const int n = mesh.vertexCount();
  uncorrected.resize(n), displacement.resize(n), held.resize(n);
  for (int i = 0; i < n; ++i) {
    if (!mesh.isRoot(i)) all_vertices.push_back(i);
  }
  penetrations.reserve(static_cast<std::size_t>(kMaxTouches) * n);
  clusterVertices(mesh, search);
  corrected.reserve(all_vertices.size());
}

void limitCorrectionWork(const WorkBounds& bounds, bool published, PositionCorrection& scratch) {
  scratch.points = scratch.minimizations = 0;
  scratch.max_points = std::numeric_limits<long>::max();
  scratch.max_minimizations = (kRounds + kPlainRounds) * kMaxMinimization;
  if (published) return;
  const auto vertices = static_cast<double>(scratch.held.size());
  scratch.max_points = std::min(static_cast<long>(kMaxPoints * vertices), bounds.surface_points);
  scratch.max_minimizations = std::min(kMaxMinimizations, bounds.minimizations);
}

void beginCorrections(PositionCorrection& scratch) {
  scratch.round = scratch.moved = 0;
  scratch.follow_speed = 0;
}

bool findContacts(const CorrectedStep& step, PositionCorrection& scratch, const HairState& state, StepReport& report) {
  if (scratch.round > 0 && (scratch.moved == 0 || scratch.round > kRounds + kPlainRounds)) return false;
  const auto& vertices = step.params.collide_inner ? scratch.all_vertices : step.mesh.external_vertices;
  const auto margins = contactMargins(step.params, step.dt);
  ContactSearch search{vertices, step.colliders, step.start, step.dt, margins, scratch.max_points};
  const bool cut = scratch.points > scratch.max_points;
  report.corrections_cut = report.corrections_cut || cut;
  // Where the way out of one body leads through another, swept tests would alternate: from here on only final
  // positions count. Where nothing followed the last corrected vertices, only these can be inside.
  if (cut || scratch.round > kRounds + 1) {
    search.start = {};
    if (scratch.round > 0 && !scratch.followed) search.vertices = scratch.corrected;
  }
  scratch.search.tests = {};
  findPenetrations(search, state.positions, scratch.search, scratch.penetrations);
  report.collider_tests += scratch.search.tests;
  if (scratch.penetrations.empty()) return false;
  if (scratch.round == 0) {
    for (const Penetration& hit : scratch.penetrations)
      report.max_penetration = std::max(report.max_penetration, hit.depth);
    std::fill(scratch.held.begin(), scratch.held.end(), 0);
    holdResting(step.mesh, state, scratch);
    scratch.uncorrected = state.positions;
  }
  return true;
}

void correctPositions(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report) {
  std::fill(scratch.displacement.begin(), scratch.displacement.end(), Vec3::Zero());
  scratch.follow_speed = std::max(scratch.follow_speed, correctionSpeed(step, scratch));
  scratch.moved = correctFound(step, contactMargins(step.params, step.dt).slack, scratch, state);
  for (const Penetration& hit : scratch.penetrations) {
    report.initial_overlap += hit.initial_overlap;
    report.initial_overlap_depth = std::max(report.initial_overlap_depth, hit.left);
  }
  report.corrected += scratch.moved;
  scratch.followed = false;
  ++scratch.round;
}

void minimizeDeformation(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report) {
  if (!step.params.minimize_deformation || scratch.moved == 0 || scratch.round > kRounds) return;
  if (scratch.points > scratch.max_points) return;
  const int work = letFollow(scratch, state);
  report.minimization_iterations += work;
  scratch.followed = work > 0;
}

void updateVelocities(const CorrectedStep& step, PositionCorrection& scratch, HairState& state) {
  if (scratch.round == 0) return;
  followCorrections(step, scratch.follow_speed, scratch, state);
  std::ranges::sort(state.contacts, {}, [](const Contact& c) { return std::pair(c.vertex, c.collider); });
}

void correctContacts(const CorrectedStep& step, PositionCorrection& scratch, HairState& state, StepReport& report) {
  beginCorrections(scratch);
  while (findContacts(step, scratch, state, report)) {
    correctPositions(step, scratch, state, report);
    minimizeDeformation(step, scratch, state, report);
  }
  updateVelocities(step, scratch, state);
}

void followPushed(const CorrectedStep& step, std::span<const Vec3> unmoved, std::span<const unsigned char> moved,
                  PositionCorrection& scratch, HairState& state) {
  std::copy(unmoved.begin(), unmoved.end(), scratch.uncorrected.begin());
  std::copy(moved.begin(), moved.end(), scratch.held.begin());
  holdResting(step.mesh, state, scratch);
  for (std::size_t i = 0; i < unmoved.size(); ++i)
    scratch.displacement[i] = moved[i] ? Vec3(state.positions[i] - unmoved[i]) : Vec3::Zero();
  letFollow(scratch, state);
  followCorrections(step, kFastestFollower, scratch, state);
}

void slowPushed(const CorrectedStep& step, std::span<const Vec3> unpushed, HairState& state) {
  for (int i = 0; i < step.mesh.vertexCount(); ++i) {
    if (state.positions[i] == unpushed[i]) continue;
    const int root = step.mesh.shape.column_first[step.mesh.column_of[i]];
    const Vec3 carried = state.positions[root] - step.start[root], carrying = state.velocities[root];
    const Vec3 way = (state.positions[i] - step.start[i] - carried) / step.dt;
    if (way.squaredNorm() >= (state.velocities[i] - carrying).squaredNorm()) continue;
    state.velocities[i] = carrying + way;
    state.restartHistory(i, step.dt);
  }
}

}  // namespace sim
