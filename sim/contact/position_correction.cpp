#include "sim/position_correction.h"

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr int kRounds = 4;               // of position correction and deformation minimization
constexpr int kPlainRounds = 8;          // more of correction alone
constexpr double kMinimization = 1e-3;   // relative residual
constexpr double kFastestFollower = 10;  // m/s that a vertex takes from following a corrected one

// A corrected vertex keeps the collider's normal velocity and loses tangential speed to friction; the new contact
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
  const auto known = std::find_if(state.contacts.begin(), state.contacts.end(), [&](const Contact& c) {
    return c.vertex == hit.vertex && c.collider == hit.collider;
  });
  if (known == state.contacts.end()) {
    Contact contact;
    contact.vertex = hit.vertex;
    contact.collider = hit.collider;
    contact.normal = hit.normal;
    state.contacts.push_back(contact);
  }
}

// Moves what was found onto the surface. Returns how many vertices were.
int correctFound(const CorrectedStep& step, double slack, PositionCorrection& scratch, HairState& state) {
  scratch.corrected.clear();
  for (const Penetration& hit : scratch.penetrations) {
    if (hit.depth > slack || hit.standing) {
      scratch.displacement[hit.vertex] = hit.target - state.positions[hit.vertex];
      scratch.held[hit.vertex] = 1;
      state.positions[hit.vertex] = hit.target;
      if (scratch.corrected.empty() || scratch.corrected.back() != hit.vertex) scratch.corrected.push_back(hit.vertex);
    }
    enterContact(step, hit, state);
  }
  return static_cast<int>(scratch.corrected.size());
}

// Speed (m/s) at which the step's own motion, not an overlap that stood before it, had to be corrected.
double correctionSpeed(const CorrectedStep& step, const PositionCorrection& scratch) {
  double most = 0;
  for (const Penetration& hit : scratch.penetrations) {
    if (!hit.standing) most = std::max(most, hit.depth);
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
  const int work = scratch.minimizer.minimize(scratch.held, kMinimization, scratch.displacement);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (!scratch.held[i]) state.positions[i] += scratch.displacement[i];
  }
  return work;
}

// As if the vertex had come here at its present velocity.
void restartHistory(const CorrectedStep& step, std::size_t i, HairState& state) {
  state.previous_positions[i] = state.positions[i] - step.dt * state.velocities[i];
  state.previous_velocities[i] = state.velocities[i];
}

// Vertices that followed take the velocity of their displacement, no more than the corrections' own: an overlap that
// stood before must not become a kick. The two-step history of all that moved restarts.
void updateVelocities(const CorrectedStep& step, double most, const PositionCorrection& scratch, HairState& state) {
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (step.mesh.isRoot(static_cast<int>(i))) continue;
    const Vec3 moved = state.positions[i] - scratch.uncorrected[i];
    const double speed = moved.norm() / step.dt;
    if (speed <= 0) continue;
    if (!scratch.held[i]) state.velocities[i] += moved * (std::min(speed, most) / (speed * step.dt));
    restartHistory(step, i, state);
  }
}

}  // namespace

PositionCorrection::PositionCorrection(const HairMesh& mesh) : minimizer(mesh) {
  const int n = mesh.vertexCount();
  uncorrected.resize(n), displacement.resize(n), held.resize(n);
  for (int i = 0; i < n; ++i) {
    if (!mesh.isRoot(i)) all_vertices.push_back(i);
  }
  penetrations.reserve(static_cast<std::size_t>(kMostTouches) * n);
  clusterVertices(mesh, search);
  corrected.reserve(all_vertices.size());
}

void correctPositions(const CorrectedStep& step, StageClock& clock, PositionCorrection& scratch, HairState& state,
                      StepReport& report) {
  const HairMesh& mesh = step.mesh;
  ContactSearch search{step.params.collide_inner ? scratch.all_vertices : mesh.external_vertices, step.colliders,
                       step.start, step.dt, contactMargins(step.params, step.dt)};
  const auto find = [&] {
    scratch.search.tests = {};
    findPenetrations(search, state.positions, scratch.search, scratch.penetrations);
    report.collider_tests += scratch.search.tests;
  };
  find();
  if (scratch.penetrations.empty()) return;
  for (const Penetration& hit : scratch.penetrations)
    report.max_penetration = std::max(report.max_penetration, hit.depth);
  std::fill(scratch.held.begin(), scratch.held.end(), 0);
  holdResting(mesh, state, scratch);
  scratch.uncorrected = state.positions;
  double follow_speed = 0;
  // Minimization may push other vertices in, which the paper leaves to future work: the rounds go on with these held as
  // well, and those that end it are without minimization: one leaves nothing inside, but where bodies overlap each may
  // push into the other.
  for (int round = 0; round <= kRounds + kPlainRounds; ++round) {
    std::fill(scratch.displacement.begin(), scratch.displacement.end(), Vec3::Zero());
    follow_speed = std::max(follow_speed, correctionSpeed(step, scratch));
    const int corrected = correctFound(step, search.margins.slack, scratch, state);
    for (const Penetration& hit : scratch.penetrations) {
      report.standing += hit.standing;
      report.standing_overlap = std::max(report.standing_overlap, hit.left);
    }
    report.corrected += corrected;
    clock.spent(kStageCollision, report);
    if (corrected == 0 || round == kRounds + kPlainRounds) break;
    // What nothing moves any more cannot have come inside. Where the way out of one body has led through another, to go
    // back by the path would be to go to and fro: to be outside is enough.
    if (round > kRounds) search.vertices = scratch.corrected, search.start = {};
    if (step.params.minimize_deformation && round < kRounds)
      report.minimization_iterations += letFollow(scratch, state);
    clock.spent(kStageMinimization, report);
    find();
  }
  updateVelocities(step, follow_speed, scratch, state);
  const auto order = [](const Contact& a, const Contact& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.collider < b.collider;
  };
  std::sort(state.contacts.begin(), state.contacts.end(), order);
}

void followPushed(const CorrectedStep& step, std::span<const Vec3> unmoved, std::span<const unsigned char> moved,
                  PositionCorrection& scratch, HairState& state) {
  std::copy(unmoved.begin(), unmoved.end(), scratch.uncorrected.begin());
  std::copy(moved.begin(), moved.end(), scratch.held.begin());
  holdResting(step.mesh, state, scratch);
  for (std::size_t i = 0; i < unmoved.size(); ++i)
    scratch.displacement[i] = moved[i] ? Vec3(state.positions[i] - unmoved[i]) : Vec3::Zero();
  letFollow(scratch, state);
  updateVelocities(step, kFastestFollower, scratch, state);
}

void slowPushed(const CorrectedStep& step, std::span<const Vec3> unpushed, HairState& state) {
  for (int c = 0; c < step.mesh.columnCount(); ++c) {
    const int root = step.mesh.shape.column_first[c];
    const Vec3 carried = state.positions[root] - step.start[root], carrying = state.velocities[root];
    for (int i = root + 1; i < step.mesh.shape.column_first[c + 1]; ++i) {
      if (state.positions[i] == unpushed[i]) continue;
      const Vec3 way = (state.positions[i] - step.start[i] - carried) / step.dt;
      if (way.squaredNorm() >= (state.velocities[i] - carrying).squaredNorm()) continue;
      state.velocities[i] = carrying + way;
      restartHistory(step, i, state);
    }
  }
}

}  // namespace sim
