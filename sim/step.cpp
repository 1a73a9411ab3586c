#include "sim/step.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "sim/bearable.h"
#include "sim/buzz.h"
#include "sim/comb_out.h"
#include "sim/energy_guard.h"
#include "sim/forces/material.h"
#include "sim/implicit_solve.h"
#include "sim/position_correction.h"
#include "sim/rest_check.h"
#include "sim/self_contact.h"

namespace sim {

namespace {

constexpr int kBalanceSlices = 40;  // steps over which the balance of gravity is solved for anew
constexpr double kAtOnce = 1e6;     // m/s
constexpr double kStorm = 5;        // m/s^2 that wind presses hair with
constexpr int kTwinIterations = 300;
constexpr double kSpringBack = 0.5;  // s, that hair takes to when the bodies that held it have gone

// The parameters that stiffnesses and rest shifts depend on.
bool sameMaterial(const SimParams& a, const SimParams& b) {
  return a.density == b.density && a.stretch_along == b.stretch_along && a.stretch_across == b.stretch_across &&
         a.stretch_edge == b.stretch_edge && a.shear == b.shear && a.bend == b.bend && a.volume == b.volume &&
         a.sag_free == b.sag_free && (a.gravity == b.gravity || !a.sag_free);
}

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
  SimParams params;
  bool has_model = false, gradual = false, as_published = false;
  std::optional<ImplicitSolver<float>> single_solver;
  std::optional<ImplicitSolver<double>> double_solver;
  // Scratch of a step.
  std::vector<Vec3> x_hat, v_hat, start_positions, start_velocities, limited_velocities, unpushed;
  std::vector<V3<double>> plain_positions;  // for the force model, which is plain arrays
  std::vector<Vec3> root_positions;         // of a teleport
  std::vector<Ellipsoid> standing;          // bodies after a teleport
  std::vector<DistancePart> standing_parts;
  GoodState good;  // the last step's end
  EnergyGuard energy_guard;
  double springing_back = 0;  // s, to come
  Buzz buzz;
  Tangles tangles;
  RestCheck rest_check;
  PositionCorrection correction;
  std::optional<SelfContact> self_contact, twin_contact;  // made when first asked for

  Parts(const HairMesh& m, double (*c)())
      : mesh(&m),
        clock{c},
        pattern(systemPattern(m)),
        material(m, pattern),
        energy_guard(m),
        buzz(m),
        tangles(m),
        rest_check(m),
        correction(m) {
    for (auto* array : {&x_hat, &v_hat, &start_positions, &start_velocities, &limited_velocities, &unpushed})
      array->resize(m.vertexCount());
    plain_positions.reserve(m.vertexCount());
  }
};

StepContext::StepContext(const HairMesh& mesh, double (*clock)()) : parts_(std::make_unique<Parts>(mesh, clock)) {}
StepContext::~StepContext() = default;
StepContext::StepContext(StepContext&&) noexcept = default;
StepContext& StepContext::operator=(StepContext&&) noexcept = default;

void StepContext::refreshGradually(bool on) {
  parts_->gradual = on;
}

void StepContext::leaveAsPublished(bool on) {
  parts_->as_published = on;
}

const char* stageName(Stage stage) {
  constexpr const char* kNames[kStageCount] = {"forces", "solve", "collision", "minimization", "other"};
  return kNames[stage];
}

namespace {

using Parts = StepContext::Parts;

// Derived values follow the parameters that they depend on. Returns whether any was made, or a slice of it.
bool refreshModel(const SimParams& params, Parts& parts) {
  const auto tell = [&](auto&& take) {
    if (parts.single_solver) take(*parts.single_solver);
    if (parts.double_solver) take(*parts.double_solver);
  };
  const auto setModel = [&](auto& solver) { solver.setModel(*parts.mesh, parts.material.model, params.density); };
  bool made = parts.material.outdated();
  if (!parts.has_model || !sameMaterial(params, parts.params)) {
    if (parts.has_model && parts.gradual) {
      parts.material.follow(params);
    } else {
      parts.material.set(params);
    }
    parts.has_model = made = true;
    tell(setModel);
  } else if (parts.material.work(kBalanceSlices)) {
    tell([&](auto& solver) { solver.setRestShifts(*parts.mesh, parts.material.model); });
  }
  parts.params = params;
  const auto ready = [&](auto& solver) {
    if (!solver) {
      solver.emplace(*parts.mesh, parts.pattern);
      setModel(*solver);
      made = true;
    }
    solver->gradual = parts.gradual;
  };
  if (params.precision == Precision::kDouble)
    ready(parts.double_solver);
  else
    ready(parts.single_solver);
  return made;
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
  return {parts.x_hat, parts.v_hat, dt * (1 + w) / (1 + 2 * w), windAt(params, input.time)};
}

// Prescribed velocities: those that bring each root where the scalp carries it by the step's end.
void rootsFollowScalp(const StepInput& input, const StepBase& base, const HairMesh& mesh, HairState& state) {
  for (int c = 0; c < mesh.columnCount(); ++c) {
    const int root = mesh.shape.column_first[c];
    state.velocities[root] = (input.roots[c] - base.x_hat[root]) / base.h;
  }
}

void solveVelocities(const SimParams& params, const StepBase& base, Parts& parts, HairState& state,
                     StepReport& report) {
  const auto solve = [&](auto& solver) {
    solver.solve(*parts.mesh, params, base, parts.clock, state.contacts, state.velocities, report);
    report.force_kinds = solver.model.kindsLeftOut();
  };
  if (params.precision == Precision::kDouble) {
    solve(*parts.double_solver);
  } else {
    solve(*parts.single_solver);
  }
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
}

Colliders collidersOf(const SimParams& params, const StepInput& input) {
  return {input.ellipsoids, params.collider == ColliderKind::kSdf ? input.parts : std::span<const DistancePart>()};
}

// As nameForce, at positions (m) as the state has them.
void nameForceAt(std::span<const Vec3> positions, Parts& parts, Trouble& trouble) {
  parts.plain_positions.clear();
  for (const Vec3& x : positions) parts.plain_positions.push_back({x.x(), x.y(), x.z()});
  nameForce(parts.material.model, parts.plain_positions, trouble);
}

// What was handed over: a state that something outside of the step has spoilt is healed before it spoils the rest.
void guardGiven(const StepInput& input, Parts& parts, HairState& state, StepReport& report) {
  Trouble trouble;
  trouble.given = true;
  heal(*parts.mesh, input.roots, parts.good, state, trouble);
  if (trouble.ailment == Ailment::kNone) return;
  ++report.recoveries;
  // Where the hair was when it was last well: of absurd places no force says anything.
  nameForceAt(parts.good.positions.empty() ? parts.mesh->shape.positions : parts.good.positions, parts, trouble);
  report.trouble = trouble;
}

TakenStep takenStep(const SimParams& params, const StepBase& base, double dt, const Parts& parts) {
  return {*parts.mesh, params, parts.material.model, parts.start_positions, parts.start_velocities, dt, base.wind};
}

// What the step made of it: where that is ill, the step's start comes back.
void guardMade(Parts& parts, const StepInput& input, HairState& state, StepReport& report) {
  Trouble trouble;
  const HairMesh& mesh = *parts.mesh;
  bool fine = true;
  for (int i = 0; i < mesh.vertexCount() && fine; ++i) fine = examine(mesh, state, i) == Ailment::kNone;
  if (fine) return;
  const std::vector<Vec3> made = state.positions;
  const GoodState start{parts.start_positions, parts.start_velocities};
  heal(mesh, input.roots, start, state, trouble);
  if (trouble.vertex >= 0) nameForceAt(made, parts, trouble);
  ++report.recoveries;
  report.trouble = trouble;
}

// A jump of the roots that no motion could make is a teleport of the second kind: the hair is carried along, and the
// bodies, which have come as far, are taken to stand where they are now.
StepInput carryOverJump(const SimParams& params, const StepInput& input, double dt, Parts& parts, HairState& state,
                        StepReport& report) {
  const HairMesh& mesh = *parts.mesh;
  if (!(rootSpeed(mesh, input.roots, dt, state) > params.teleport_speed)) return input;
  parts.root_positions.clear();
  for (int c = 0; c < mesh.columnCount(); ++c)
    parts.root_positions.push_back(state.positions[mesh.shape.column_first[c]]);
  carryAlong(Eigen::Isometry3d::Identity(), rigidMotion(parts.root_positions, input.roots), state);
  state.contacts.clear();
  parts.standing.assign(input.ellipsoids.begin(), input.ellipsoids.end());
  for (Ellipsoid& e : parts.standing) e.velocity = e.angular_velocity = Vec3::Zero();
  report.carried = true;
  parts.standing_parts.assign(input.parts.begin(), input.parts.end());
  for (DistancePart& part : parts.standing_parts) part.bounds.velocity = part.bounds.angular_velocity = Vec3::Zero();
  return {input.roots, parts.standing, input.time, parts.standing_parts};
}

// Bundles that met are pushed apart, the rest of the hair follows, and who is in a foreign bundle then is pushed again.
// taken: null where energy need not pay for it.
void partBundles(const CorrectedStep& step, const TakenStep* taken, std::optional<SelfContact>& made, Parts& parts,
                 HairState& state, StepReport& report) {
  if (!made) made.emplace(step.mesh);
  SelfContact& self = *made;
  report.self_contacts = resolveSelfContacts({step.mesh, step.params, step.start, step.dt}, self, state);
  if (report.self_contacts == 0) return;
  parts.unpushed = self.unmoved;
  if (step.params.minimize_deformation) {
    followPushed(step, self.unmoved, self.moved, parts.correction, state);
    resolveSelfContacts({step.mesh, step.params, {}, step.dt}, self, state);
  }
  if (taken) limitPushes(*taken, parts.unpushed, parts.energy_guard, state);
  slowPushed(step, parts.unpushed, state);
}

// Whether hair is in contact with a body that is there no more.
bool bodyHasGone(const SimParams& params, const Colliders& colliders, const HairState& state) {
  return std::ranges::any_of(
      state.contacts, [&](const Contact& contact) { return !params.collide || contact.collider >= colliders.count(); });
}

// No vertex goes to and fro for ever, no step makes energy out of nothing, and no hair stays turned over.
// Let go by bodies that have gone, it springs back further than the forces stay linear over.
void keepWithinBounds(const TakenStep& taken, Parts& parts, HairState& state, StepReport& report) {
  const bool held = relaxBuzz(taken.mesh, taken.positions, parts.buzz, state) > 0;
  limitEnergy(taken, report.converged && !held && parts.springing_back <= 0, parts.energy_guard, state);
  // Loose particles have no shape to be led back to.
  if (taken.params.volume <= 0) return;
  // In a storm the rest shape is not where hair belongs: combed towards it, it would be thrown about for ever.
  const bool looks = blowOf(taken.params) < kStorm;
  report.combed = combOut({taken.mesh, taken.positions, taken.dt, looks}, parts.tangles, state);
}

// Corrects what is inside of bodies, as far as the energy that the step began with pays for it (taken: null where it
// need not).
void keepOutside(const CorrectedStep& step, const TakenStep* taken, Parts& parts, HairState& state,
                 StepReport& report) {
  correctPositions(step, parts.clock, parts.correction, state, report);
  // Overlaps that stood before are lifted out whatever it takes.
  if (!taken || report.corrected == 0 || report.standing > 0) return;
  if (limitCorrections(*taken, step.colliders, parts.energy_guard, state) == 1) return;
  // Halfway between two places outside of a body may lie its inside: that nothing is left there comes first, but it
  // leaves no velocity behind.
  parts.limited_velocities = state.velocities;
  correctPositions(step, parts.clock, parts.correction, state, report);
  state.velocities = parts.limited_velocities;
}

// Kinetic, elastic and gravitational energy, and that of the wind's push on hair that does not move (J).
double energyOf(const SimParams& params, const Vec3& wind, const HairState& state, Parts& parts) {
  parts.plain_positions.resize(state.positions.size());
  double energy = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Vec3 &x = state.positions[i], &v = state.velocities[i];
    parts.plain_positions[i] = {x.x(), x.y(), x.z()};
    const double specific = 0.5 * v.squaredNorm() + params.gravity * x.y() - params.air_drag * wind.dot(x);
    energy += params.density * parts.mesh->vertex_volume[i] * specific;
  }
  return energy + evaluate<double>(parts.material.model, parts.plain_positions, {});
}

// Hair that hangs still in another shape than its own is led home.
void checkRest(const SimParams& asked, const StepInput& input, double dt, Parts& parts, const HairState& state,
               StepReport& report) {
  const HairMesh& mesh = *parts.mesh;
  RestCheck& check = parts.rest_check;
  SimParams params = asked;
  // Led by solves that end early the twin might hang wherever they leave it.
  params.max_iterations = std::max(params.max_iterations, kTwinIterations);
  const Vec3 pull = params.air_drag * windAt(params, input.time) - Vec3(0, params.gravity, 0);
  check.self_contact = params.self_collide;
  if (!watchRest(mesh, state, pull.norm(), dt, parts.tangles, check)) return;
  HairState& twin = check.twin;
  parts.start_positions = twin.positions;
  parts.start_velocities = twin.velocities;
  const StepBase base = integratorBase(params, input, dt, twin, parts);
  rootsFollowScalp(input, base, mesh, twin);
  StepReport unseen;
  solveVelocities(params, base, parts, twin, unseen);
  integratePositions(input, base, dt, mesh, parts, twin);
  const TakenStep taken = takenStep(params, base, dt, parts);
  limitEnergy(taken, unseen.converged, parts.energy_guard, twin);
  if (check.kept_apart) {
    const Colliders none{};
    partBundles({mesh, params, none, parts.start_positions, dt}, &taken, parts.twin_contact, parts, twin, unseen);
  }
  const auto energy = [&](const HairState& one) { return energyOf(params, base.wind, one, parts); };
  double weight = 0;  // N
  for (const double share : mesh.vertex_volume) weight += 9.81 * params.density * share;
  // By reference: a copy within the std::function would be allocated, in a step.
  judgeRest(mesh, state, weight * mesh.hair_length, std::cref(energy), parts.tangles, check);
  for (const double seconds : unseen.seconds) report.seconds[kStageOther] += seconds;
  parts.clock.spent(kStageOther, report);
}

}  // namespace

StepReport advance(const HairMesh& mesh, const SimParams& asked, const StepInput& given, double dt,
                   StepContext& context, HairState& state) {
  Parts& parts = context.parts();
  SimParams params = bearable(mesh, asked);
  StepReport report;
  parts.clock.start();
  state.contacts.reserve(static_cast<std::size_t>(kMostTouches) * mesh.vertexCount());
  report.refreshes = {!refreshModel(params, parts), 1};
  guardGiven(given, parts, state, report);
  const StepInput input = carryOverJump(params, given, dt, parts, state, report);
  // Where the jump has put the hair into a body, nobody has seen it go there: it is out at once.
  if (report.carried) params.max_depenetration = kAtOnce;
  parts.start_positions = state.positions;
  parts.start_velocities = state.velocities;
  const Colliders colliders = collidersOf(params, input);
  const bool let_go = bodyHasGone(params, colliders, state);
  parts.springing_back = let_go ? kSpringBack : std::max(0.0, parts.springing_back - dt);
  carryContacts(colliders, params, dt, state);
  const StepBase base = integratorBase(params, input, dt, state, parts);
  rootsFollowScalp(input, base, mesh, state);
  parts.clock.spent(kStageOther, report);

  solveVelocities(params, base, parts, state, report);
  integratePositions(input, base, dt, mesh, parts, state);
  const bool bounded = params.solver != Solver::kPaper || !parts.as_published;
  const TakenStep taken = takenStep(params, base, dt, parts);
  if (bounded) keepWithinBounds(taken, parts, state, report);
  guardMade(parts, input, state, report);
  parts.clock.spent(kStageOther, report);

  const CorrectedStep corrected{mesh, params, colliders, parts.start_positions, dt};
  if (params.self_collide) {
    partBundles(corrected, bounded ? &taken : nullptr, parts.self_contact, parts, state, report);
    parts.clock.spent(kStageCollision, report);
  }
  if (params.collide) {
    keepOutside(corrected, bounded ? &taken : nullptr, parts, state, report);
    if (bounded) limitSpeed(mesh, state);
    parts.clock.spent(kStageCollision, report);
  }
  if (bounded && params.volume > 0) checkRest(params, input, dt, parts, state, report);
  parts.good.positions = state.positions;
  parts.good.velocities = state.velocities;
  report.contacts = static_cast<int>(state.contacts.size());
  return report;
}

double mechanicalEnergy(const HairMesh& mesh, const SimParams& asked, StepContext& context, const HairState& state) {
  Parts& parts = context.parts();
  const SimParams params = bearable(mesh, asked);
  refreshModel(params, parts);
  return energyOf(params, Vec3::Zero(), state, parts);
}

HairState restState(const HairMesh& mesh, const Eigen::Isometry3d& head_to_world) {
  HairState state;
  for (const Vec3& p : mesh.shape.positions) state.positions.push_back(head_to_world * p);
  state.velocities.assign(mesh.vertexCount(), Vec3::Zero());
  return state;
}

void carryAlong(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, HairState& state) {
  const Eigen::Isometry3d move = to * from.inverse();
  for (auto* positions : {&state.positions, &state.previous_positions}) {
    for (Vec3& p : *positions) p = move * p;
  }
  for (auto* velocities : {&state.velocities, &state.previous_velocities}) {
    for (Vec3& v : *velocities) v = move.linear() * v;
  }
  for (Contact& contact : state.contacts) contact.normal = move.linear() * contact.normal;
}

void collapseOntoRoots(const HairMesh& mesh, HairState& state) {
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    state.positions[i] = state.positions[mesh.shape.column_first[mesh.column_of[i]]];
    state.velocities[i].setZero();
  }
  state.contacts.clear();
  state.previous_dt = 0;
}

}  // namespace sim
