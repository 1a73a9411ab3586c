#include "sim/stabilization/stabilize.h"

#include <algorithm>
#include <cmath>

#include "sim/mesh/rigid_motion.h"
#include "sim/stabilization/parameter_limits.h"
#include "sim/step.h"

namespace sim {
namespace {

constexpr double kMaxStretch = 2;             // times the hair between root and vertex
constexpr double kStorm = 5;                  // m/s^2 of wind, above which the rest shape is not where hair belongs
constexpr int kMinReferenceIterations = 300;  // a reference hair of loose solves might hang wherever they leave it
constexpr double kAtOnce = 1e6;               // m/s

// Names the force at the vertex in `fault`, at positions `x` (m).
void nameForceAt(const ForceModel<double>& model, std::span<const Vec3> x, Stabilization& scratch, FaultReport& fault) {
  scratch.plain_positions.clear();
  for (const Vec3& p : x) scratch.plain_positions.push_back({p.x(), p.y(), p.z()});
  nameForce(model, scratch.plain_positions, fault);
}

// Puts `good` back where `state` is not finite or absurd, and says so in the report. `given`: FaultReport's.
void repairState(const HairMesh& mesh, const ForceModel<double>& model, std::span<const Vec3> roots,
                 const KeptState& good, bool given, Stabilization& scratch, HairState& state, StepReport& report) {
  FaultReport fault;
  fault.given = given;
  repair(mesh, roots, good, state, fault);
  if (fault.fault == StateFault::kNone) return;
  ++report.recoveries;
  // At the last good place: of absurd places no force says anything.
  nameForceAt(model, good.positions.empty() ? mesh.shape.positions : good.positions, scratch, fault);
  report.fault_report = fault;
}

StepInput teleport(const HairMesh& mesh, const StepInput& input, Stabilization& scratch, HairState& state) {
  scratch.root_positions.clear();
  for (int c = 0; c < mesh.columnCount(); ++c)
    scratch.root_positions.push_back(state.positions[mesh.shape.column_first[c]]);
  carryAlong(Eigen::Isometry3d::Identity(), rigidMotion(scratch.root_positions, input.roots), state);
  state.contacts.clear();
  scratch.still_bodies.assign(input.ellipsoids.begin(), input.ellipsoids.end());
  for (Ellipsoid& body : scratch.still_bodies) body.velocity = body.angular_velocity = Vec3::Zero();
  scratch.still_parts.assign(input.parts.begin(), input.parts.end());
  scratch.still_parts.insert(scratch.still_parts.end(), input.attached.begin(), input.attached.end());
  for (BodySdf& part : scratch.still_parts) part.bounds.velocity = part.bounds.angular_velocity = Vec3::Zero();
  scratch.still_pins.assign(input.pins.begin(), input.pins.end());
  for (PinnedVertex& pin : scratch.still_pins) pin.velocity.setZero();
  StepInput still = input;
  still.ellipsoids = scratch.still_bodies, still.pins = scratch.still_pins;
  still.parts = std::span(scratch.still_parts).first(input.parts.size());
  still.attached = std::span(scratch.still_parts).subspan(input.parts.size());
  return still;
}

// Bodies faster than hair can follow draw it out further in every step.
void limitStretch(const HairMesh& mesh, std::span<const double> reach, HairState& state) {
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    const int root = mesh.shape.column_first[mesh.column_of[i]];
    const Vec3 arm = state.positions[i] - state.positions[root];
    const double square = arm.squaredNorm();
    if (!(square > reach[i] * reach[i])) continue;
    state.positions[i] = state.positions[root] + reach[i] / std::sqrt(square) * arm;
    const double away = (state.velocities[i] - state.velocities[root]).dot(arm) / square;
    state.velocities[i] -= std::max(0.0, away) * arm;
    state.restartHistory(i, state.previous_dt);
  }
}

}  // namespace

Stabilization::Stabilization(const HairMesh& mesh) : energy_limit(mesh), touched(mesh.vertexCount()) {
  limited_velocities.resize(mesh.vertexCount());
  plain_positions.reserve(mesh.vertexCount());
  for (int i = 0; i < mesh.vertexCount(); ++i)
    reach.push_back(mesh.isRoot(i) ? 0 : reach.back() + kMaxStretch * restLength(mesh, i - 1, i));
}

StepInput admitState(const HairMesh& mesh, const ForceModel<double>& model, const StepInput& input, double dt,
                     SimParams& params, Stabilization& scratch, HairState& state, StepReport& report) {
  const GoodState& good = state.memory.good;
  if (scratch.active.input_repair)
    repairState(mesh, model, input.roots, {good.positions, good.velocities}, true, scratch, state, report);
  report.carried = scratch.active.teleport && rootSpeed(mesh, input.roots, dt, state) > params.teleport_speed;
  if (!report.carried) return input;
  params.max_depenetration = kAtOnce;
  return teleport(mesh, input, scratch, state);
}

void stabilize(const TakenStep& step, const StepInput& input, bool converged, Stabilization& scratch, HairState& state,
               StepReport& report) {
  const SafetyNets& nets = scratch.active;
  if (nets.step_energy) limitEnergy(step, converged, scratch.energy_limit, state);
  // Loose particles have no length, and no shape to be guided to.
  if (nets.stretch_limit && step.params.volume > 0) limitStretch(step.mesh, scratch.reach, state);
  if (nets.inversion_recovery && step.params.volume > 0) {
    const bool looks = windLoad(step.params) < kStorm;
    report.guided = recoverInversions({step.mesh, step.positions, step.dt, looks, step.pins}, scratch.touched, state);
  }
  if (nets.result_repair)
    repairState(step.mesh, step.model, input.roots, {step.positions, step.velocities}, false, scratch, state, report);
}

void limitCorrectionEnergy(const TakenStep& step, const CorrectedStep& corrected, PositionCorrection& correction,
                           Stabilization& scratch, HairState& state, StepReport& report) {
  // Initial overlaps are lifted out whatever it takes.
  const bool moved = report.corrected > 0 || report.self_contacts > 0;
  if (!scratch.active.correction_energy || !moved || report.initial_overlap > 0) return;
  if (limitCorrections(step, corrected.colliders, scratch.energy_limit, state) == 1 || !step.params.collide) return;
  // Halfway between two places outside of a body may lie its inside. Nothing may be left there.
  scratch.limited_velocities = state.velocities;
  correctContacts(corrected, correction, state, report);
  state.velocities = scratch.limited_velocities;
}

void finishStep(const TakenStep& step, const std::function<void(const SimParams&, HairState&)>& advance_reference,
                const std::function<double(const HairState&)>& energy, Stabilization& scratch, HairState& state) {
  const HairMesh& mesh = step.mesh;
  state.memory.good.positions = state.positions;
  state.memory.good.velocities = state.velocities;
  if (!scratch.active.reference_hair || step.params.volume <= 0) return;
  const Vec3 pull = step.params.air_drag * step.wind - Vec3(0, step.params.gravity, 0);
  const double weight = 9.81 * step.params.density * mesh.total_volume;  // N
  const RestStep rest{mesh, step.dt, pull.norm(), weight * mesh.hair_length, step.params.self_collide};
  if (!watchRest(rest, state)) return;
  SimParams params = step.params;
  params.max_iterations = std::max(params.max_iterations, kMinReferenceIterations);
  advance_reference(params, state.memory.rest.reference.front());
  judgeRest(rest, energy, state);
}

}  // namespace sim
