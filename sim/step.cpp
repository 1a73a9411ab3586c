#include "sim/step.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "sim/contact/position_correction.h"
#include "sim/contact/self_contact.h"
#include "sim/forces/rest_balance.h"
#include "sim/implicit_solve.h"
#include "sim/stabilization/parameter_limits.h"
#include "sim/stabilization/stabilize.h"

namespace sim {

namespace {

constexpr double kSameDirections = 1e-12;  // of a rotation that is none but for rounding

Vec3 windAt(const SimParams& params, double time) {
  // Gusts: two incommensurate periods, so that they do not repeat visibly.
  const double gust = params.gust * (0.6 * std::sin(2.1 * time) + 0.4 * std::sin(5.3 * time + 1.7));
  return (1 + gust) * Vec3(params.wind_x, params.wind_y, params.wind_z);
}

}  // namespace

struct StepContext::Parts {
  const HairMesh* mesh;
  StageClock clock;
  BlockPattern pattern;
  Material material;
  bool gradual = false;
  std::optional<ImplicitSolver<float>> single_solver;
  std::optional<ImplicitSolver<double>> double_solver;
  Stabilization stabilization;
  PositionCorrection correction;
  std::optional<SelfContact> self_contact, reference_contact;  // made when first asked for
  // Scratch of a step.
  std::vector<PinnedVertex> pins;  // that hold
  std::vector<Vec3> x_hat, v_hat, start_positions, start_velocities, unpushed;
  bool restarted = false;  // the step before was taken back, or there was none

  Parts(const HairMesh& m, double (*c)())
      : mesh(&m), clock{c}, pattern(systemPattern(m)), material(m, pattern), stabilization(m), correction(m) {
    for (auto* array : {&x_hat, &v_hat, &start_positions, &start_velocities, &unpushed}) array->resize(m.vertexCount());
  }
};

StepContext::StepContext(const HairMesh& mesh, double (*clock)()) : parts_(std::make_unique<Parts>(mesh, clock)) {}
StepContext::~StepContext() = default;
StepContext::StepContext(StepContext&&) noexcept = default;
StepContext& StepContext::operator=(StepContext&&) noexcept = default;

void StepContext::refreshGradually(bool on) {
  parts_->gradual = on;
}

void StepContext::reshape(HairState& state) {
  Parts& parts = *parts_;
  parts.material.reshape();
  const double density = parts.material.memory().params.density;
  const auto follow = [&](auto& solver) {
    if (solver && parts.material.memory().known) solver->setModel(*parts.mesh, parts.material.model, density);
  };
  follow(parts.single_solver);
  follow(parts.double_solver);
  parts.stabilization.energy_limit.stored.forget();
  parts.self_contact.reset();
  parts.reference_contact.reset();
  state.memory.material = parts.material.memory();
  RestMemory& rest = state.memory.rest;
  rest.still = 0;
  rest.settling = -1;
  rest.judged = rest.kept_apart = false;
  state.memory.self_contact = {};
}

Material& StepContext::material() {
  return parts_->material;
}

SafetyNets& StepContext::safetyNets() {
  return parts_->stabilization.nets;
}

namespace {

using Parts = StepContext::Parts;

struct Refresh {
  bool made = false;     // a derived value, or a slice of it
  bool changed = false;  // the model is not that of the step before
};

// Derived values follow the parameters that they depend on, from where `memory` is.
Refresh refreshModel(const SimParams& params, MaterialMemory& memory, Parts& parts) {
  Material& material = parts.material;
  const auto setModel = [&](auto& solver) { solver.setModel(*parts.mesh, material.model, params.density); };
  const bool changed = !memory.known || !sameMaterial(params, memory.params), follows = parts.gradual && memory.known;
  bool other = (!memory.known && material.start(params)) ||
               material.recall(changed && !follows ? MaterialMemory{true, params, params, params} : memory);
  Refresh refresh{other || changed || material.outdated(), changed};
  if (changed && follows) {
    material.follow(params);
    other = true;
  } else if (!changed && material.work()) {
    other = refresh.changed = true;
  }
  memory = material.memory();
  if (other && parts.single_solver) setModel(*parts.single_solver);
  if (other && parts.double_solver) setModel(*parts.double_solver);
  if (other) parts.stabilization.energy_limit.stored.forget();
  const auto ready = [&](auto& solver) {
    if (!solver) {
      solver.emplace(*parts.mesh);
      setModel(*solver);
      refresh.made = true;
    }
  };
  if (params.precision == Precision::kDouble)
    ready(parts.double_solver);
  else
    ready(parts.single_solver);
  return refresh;
}

// The integrator's base: where the step would end, and how fast, were the new velocity zero and the forces none.
StepBase integratorBase(const SimParams& params, const StepInput& input, double dt, const HairState& state,
                        Parts& parts) {
  const std::size_t n = state.positions.size();
  const bool two_step = params.integrator == Integrator::kBdf2 && state.previous_dt > 0 &&
                        state.previous_positions.size() == n && state.previous_velocities.size() == n;
  // Variable-step BDF2: with w = dt / previous dt, y_hat = ((1 + w)^2 y_n - w^2 y_{n-1}) / (1 + 2 w), h = dt (1 + w) /
  // (1 + 2 w).
  const double w = two_step ? dt / state.previous_dt : 0;
  const double now = (1 + w) * (1 + w) / (1 + 2 * w), before = w * w / (1 + 2 * w);
  for (std::size_t i = 0; i < n; ++i) {
    parts.x_hat[i] = now * state.positions[i];
    parts.v_hat[i] = now * state.velocities[i];
    if (two_step) {
      parts.x_hat[i] -= before * state.previous_positions[i];
      parts.v_hat[i] -= before * state.previous_velocities[i];
    }
  }
  return {parts.x_hat, parts.v_hat, dt * (1 + w) / (1 + 2 * w), windAt(params, input.time), parts.pins};
}

// The pins that hold in this step. Where a vertex is firmly pinned, contacts say nothing more.
void holdPins(const StepInput& input, double dt, Parts& parts, HairState& state, StepReport& report) {
  report.pins_out_of_reach = holdingPins(*parts.mesh, input.pins, input.roots, dt, state, parts.pins);
  report.pins = static_cast<int>(parts.pins.size());
  parts.material.setMoving(parts.pins);
  std::erase_if(state.contacts, [&](const Contact& contact) {
    return std::ranges::any_of(parts.pins,
                               [&](const PinnedVertex& pin) { return pin.firm() && pin.vertex == contact.vertex; });
  });
}

// Corrections may have moved what is pinned.
void keepPinned(Parts& parts, HairState& state, StepReport& report) {
  placePinned(parts.pins, state);
  for (const PinnedVertex& pin : parts.pins) {
    if (pin.firm()) continue;
    const double stretch = (state.positions[pin.vertex] - pin.target).norm();
    report.pin_force = std::max(report.pin_force, pin.stiffness * stretch);
  }
}

// Prescribed velocities: those that bring each root where the scalp carries it by the step's end.
void rootsFollowScalp(const StepInput& input, const StepBase& base, const HairMesh& mesh, HairState& state) {
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int root = mesh.shape.column_first[c];
    state.velocities[root] = (input.roots[c] - base.x_hat[root]) / base.h;
  }
}

enum class ContactVelocity { kOfSolve, kOfWay };

// Between solves a contact's velocity is its way over the time step. A solve holds the vertex to the velocity that
// brings it to that way's end: of two-step integration another, for x_hat is not where the step begins.
void setContactVelocities(ContactVelocity as, const StepBase& base, double dt, HairState& state) {
  for (Contact& contact : state.contacts) {
    Vec3& v = contact.velocity;
    const Vec3 ahead = base.x_hat[contact.vertex] - state.positions[contact.vertex];
    v = as == ContactVelocity::kOfSolve ? Vec3(dt / base.h * v - ahead / base.h) : base.h / dt * v + ahead / dt;
  }
}

void solveVelocities(const SimParams& params, const StepBase& base, double dt, SolveMemory& memory, Parts& parts,
                     HairState& state, StepReport& report) {
  setContactVelocities(ContactVelocity::kOfSolve, base, dt, state);
  const auto solve = [&](auto& solver) {
    solver.model.setMoving(parts.material.model, base.x_hat[0]);
    solver.solve(*parts.mesh, params, base, parts.clock, state.contacts, memory, state.velocities, report);
  };
  report.force_kinds = parts.material.model.kindsLeftOut();
  if (params.precision == Precision::kDouble) {
    solve(*parts.double_solver);
  } else {
    solve(*parts.single_solver);
  }
  setContactVelocities(ContactVelocity::kOfWay, base, dt, state);
}

void integratePositions(const StepInput& input, const StepBase& base, double dt, const HairMesh& mesh,
                        const Parts& parts, HairState& state) {
  state.previous_positions = parts.start_positions;
  state.previous_velocities = parts.start_velocities;
  state.previous_dt = dt;
  for (std::size_t i = 0; i < state.positions.size(); ++i)
    state.positions[i] = base.x_hat[i] + base.h * state.velocities[i];
  // Exactly on the scalp, without the rounding of the multiplication.
  for (int c = 0; c < mesh.columnCount(); ++c) state.positions[mesh.shape.column_first[c]] = input.roots[c];
  placePinned(parts.pins, state);
}

Colliders collidersOf(const SimParams& params, const StepInput& input, Parts& parts) {
  return {input.ellipsoids, params.collider == ColliderKind::kSdf ? input.parts : std::span<const BodySdf>(),
          &parts.correction.points, input.attached};
}

TakenStep takenStep(const SimParams& params, const StepBase& base, double dt, const Parts& parts) {
  return {*parts.mesh, params,    parts.material.model, parts.start_positions, parts.start_velocities,
          dt,          base.wind, parts.pins,           parts.restarted};
}

// Bundles that met are pushed apart and the rest of the hair follows; what then lies in a foreign bundle is pushed
// again. Hair that is guided as a whole passes through itself: its bundles would hold it.
void partBundles(const CorrectedStep& step, std::optional<SelfContact>& made, Parts& parts, HairState& state,
                 StepReport& report) {
  if (report.guided == step.mesh.columnCount()) return;
  if (!made) made.emplace(step.mesh);
  SelfContact& self = *made;
  report.self_contacts = resolveSelfContacts({step.mesh, step.params, step.start, step.dt}, self, state);
  if (report.self_contacts == 0) return;
  parts.unpushed = self.unmoved;
  if (step.params.minimize_deformation) {
    followPushed(step, self.unmoved, self.moved, parts.correction, state);
    resolveSelfContacts({step.mesh, step.params, {}, step.dt}, self, state);
  }
  slowPushed(step, parts.unpushed, state);
}

// Kinetic, elastic and gravitational energy, and that of the wind's push on hair that does not move (J).
double energyOf(const SimParams& params, const Vec3& wind, const HairState& state, Parts& parts) {
  ++parts.stabilization.energy_limit.energies;
  double energy = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Vec3 &x = state.positions[i], &v = state.velocities[i];
    const double specific = 0.5 * v.squaredNorm() + params.gravity * x.y() - params.air_drag * wind.dot(x);
    energy += params.density * parts.mesh->vertex_volume[i] * specific;
  }
  return energy + parts.stabilization.energy_limit.stored.at(parts.material.model, state.positions);
}

std::span<const Vec3> rememberStart(const HairState& state, Parts& parts) {
  parts.start_positions = state.positions;
  parts.start_velocities = state.velocities;
  parts.restarted = state.previous_dt <= 0;
  return parts.start_positions;
}

// One step of the reference hair: solve, integration, energy limit and, where it is kept apart, self-contact.
void advanceReference(const SimParams& params, const StepInput& input, double dt, HairMemory& memory, Parts& parts,
                      HairState& reference, StepReport& report) {
  const HairMesh& mesh = *parts.mesh;
  Stabilization& nets = parts.stabilization;
  rememberStart(reference, parts);
  const StepBase base = integratorBase(params, input, dt, reference, parts);
  rootsFollowScalp(input, base, mesh, reference);
  StepReport own;
  solveVelocities(params, base, dt, memory.solve, parts, reference, own);
  integratePositions(input, base, dt, mesh, parts, reference);
  const TakenStep taken = takenStep(params, base, dt, parts);
  if (nets.active.step_energy) limitEnergy(taken, own.converged, nets.energy_limit, reference);
  if (memory.rest.kept_apart)
    partBundles({mesh, params, {}, parts.start_positions, dt}, parts.reference_contact, parts, reference, own);
  for (const double seconds : own.seconds) report.seconds[kStageOther] += seconds;
  report.work += own.work;
}

SimParams limited(const HairMesh& mesh, const SimParams& asked, const Parts& parts) {
  return parts.stabilization.nets.parameter_limits ? limitedParameters(mesh, asked) : asked;
}

// Counts start anew, within the budget `max_work` (StepInput).
void limitWork(double max_work, int contacts, Parts& parts, SimParams& params) {
  const WorkBounds bounds = boundsWithin(parts.mesh->vertexCount(), contacts, max_work);
  params.max_iterations = std::min(params.max_iterations, bounds.iterations);
  limitCorrectionWork(bounds, params.solver == Solver::kPaper, parts.correction);
  parts.stabilization.energy_limit.energies = 0;
  parts.stabilization.energy_limit.carried_energy.reset();
}

// Starts the clock and brings what is derived from mesh and parameters up to date. Returns the step's parameters.
SimParams beginStep(const HairMesh& mesh, const SimParams& asked, double max_work, Parts& parts, HairState& state,
                    StepReport& report) {
  parts.clock.start();
  SimParams params = limited(mesh, asked, parts);
  limitWork(max_work, static_cast<int>(state.contacts.size()), parts, params);
  parts.stabilization.active = params.solver == Solver::kPaper ? kAsPublished : parts.stabilization.nets;
  sizeMemory(mesh, state.memory);
  state.contacts.reserve(static_cast<std::size_t>(kMaxTouches) * mesh.vertexCount());
  const Refresh refresh = refreshModel(params, state.memory.material, parts);
  report.refreshes = {!refresh.made, 1};
  if (refresh.changed) state.memory.solve.two_level.forget();
  return params;
}

void endStep(const TakenStep& taken, const StepInput& input, Parts& parts, HairState& state, StepReport& report) {
  const auto advance_reference = [&](const SimParams& params, HairState& reference) {
    advanceReference(params, input, taken.dt, state.memory, parts, reference, report);
  };
  const auto energy = [&](const HairState& one) { return energyOf(taken.params, taken.wind, one, parts); };
  keepPinned(parts, state, report);
  // By reference: a copy within the std::function would be allocated, in a step.
  finishStep(taken, std::cref(advance_reference), std::cref(energy), parts.stabilization, state);
  parts.clock.spent(kStageOther, report);
  report.contacts = static_cast<int>(state.contacts.size());
  report.work += {.energies = parts.stabilization.energy_limit.energies,
                  .minimizations = parts.correction.minimizations,
                  .surface_points = parts.correction.points};
  report.work_units = workUnits(taken.mesh.vertexCount(), report.work);
}

}  // namespace

// Equations (1) to (4) are those of Wu and Yuksel (2016), BW those of Baraff and Witkin (1998).
StepReport advance(const HairMesh& mesh, const SimParams& asked, const StepInput& given, double dt,
                   StepContext& context, HairState& state) {
  Parts& parts = context.parts();
  StepReport report;
  // Context: derived values follow the parameters, contacts follow the bodies.
  SimParams params = beginStep(mesh, asked, given.max_work, parts, state, report);
  const StepInput input = admitState(mesh, parts.material.model, given, dt, params, parts.stabilization, state, report);
  const CorrectedStep step{mesh, params, collidersOf(params, input, parts), rememberStart(state, parts), dt};
  carryContacts(step.colliders, params, dt, state);
  // Roots and pins.
  holdPins(input, dt, parts, state, report);
  const StepBase base = integratorBase(params, input, dt, state, parts);
  rootsFollowScalp(input, base, mesh, state);
  parts.clock.spent(kStageOther, report);
  // Forces (1), (2) and Hessians; implicit solve by Modified PCG (BW 16).
  solveVelocities(params, base, dt, state.memory.solve, parts, state, report);
  report.solve_cut = !report.converged && params.max_iterations < asked.max_iterations;
  integratePositions(input, base, dt, mesh, parts, state);
  const TakenStep taken = takenStep(params, base, dt, parts);
  stabilize(taken, input, report.converged, parts.stabilization, state, report);
  parts.clock.spent(kStageOther, report);
  // Contacts: position correction and deformation minimization (3), (4), figures 4 and 5.
  if (params.self_collide) partBundles(step, parts.self_contact, parts, state, report);
  beginCorrections(parts.correction);
  while (params.collide && findContacts(step, parts.correction, state, report)) {
    correctPositions(step, parts.correction, state, report);
    parts.clock.spent(kStageCollision, report);
    minimizeDeformation(step, parts.correction, state, report);
    parts.clock.spent(kStageMinimization, report);
  }
  updateVelocities(step, parts.correction, state);
  limitCorrectionEnergy(taken, step, parts.correction, parts.stabilization, state, report);
  parts.clock.spent(kStageCollision, report);
  endStep(taken, input, parts, state, report);
  return report;
}

HairState restState(const HairMesh& mesh, const Eigen::Isometry3d& head_to_world) {
  HairState state;
  for (const Vec3& p : mesh.shape.positions) state.positions.push_back(head_to_world * p);
  state.velocities.assign(mesh.vertexCount(), Vec3::Zero());
  return state;
}

void carryAlong(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, HairState& state) {
  const Eigen::Isometry3d move = to * from.inverse();
  const auto carry = [&](std::vector<Vec3>& points) {
    for (Vec3& p : points) p = move * p;
  };
  const auto turn = [&](std::vector<Vec3>& directions) {
    for (Vec3& v : directions) v = move.linear() * v;
  };
  HairMemory& memory = state.memory;
  for (auto* points : {&state.positions, &state.previous_positions, &memory.good.positions, &memory.self_contact.start,
                       &memory.self_contact.end})
    carry(*points);
  for (auto* directions : {&state.velocities, &state.previous_velocities, &memory.good.velocities,
                           &memory.solve.projection.changes[0], &memory.solve.projection.changes[1]})
    turn(*directions);
  for (Contact& contact : state.contacts) {
    for (Vec3* direction : {&contact.normal, &contact.velocity, &contact.friction_direction})
      *direction = move.linear() * *direction;
  }
  for (HairState& reference : memory.rest.reference) carryAlong(from, to, reference);
  // Factors are of matrices in world directions.
  if (!move.linear().isIdentity(kSameDirections)) memory.solve.two_level.forget();
}

void collapseOntoRoots(const HairMesh& mesh, HairState& state) {
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    state.positions[i] = state.positions[mesh.shape.column_first[mesh.column_of[i]]];
    state.velocities[i].setZero();
  }
  state.contacts.clear();
  state.previous_dt = 0;
  state.memory = {};
}

}  // namespace sim
