#include "sim/step.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/contact.h"
#include "sim/deformation.h"
#include "sim/forces/material.h"
#include "sim/implicit_solve.h"

namespace sim {

namespace {

constexpr int kBalanceSlices = 40;    // steps over which the balance of gravity is solved for anew
constexpr int kCorrectionRounds = 4;  // of position correction and deformation minimization

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
  double (*clock)();
  BlockPattern pattern;
  EdgeLaplacian laplacian;
  Material material;
  SimParams params;
  bool has_model = false, gradual = false;
  std::optional<ImplicitSolver<float>> single_solver;
  std::optional<ImplicitSolver<double>> double_solver;
  // Scratch of a step.
  std::vector<Vec3> x_hat, v_hat, start_positions, start_velocities, uncorrected, displacement;
  std::vector<Penetration> penetrations;
  std::vector<unsigned char> held;
  std::vector<V3<double>> plain_positions;  // for the force model, which is plain arrays
  std::vector<Vec3> root_positions;         // of a teleport
  std::vector<Ellipsoid> standing;          // bodies after a teleport
  GoodState good;                           // the last step's end
  MinimizationScratch minimization;
  double started = 0;

  Parts(const HairMesh& m, double (*c)())
      : mesh(&m), clock(c), pattern(systemPattern(m)), laplacian(makeEdgeLaplacian(m)), material(m, pattern) {
    const int n = m.vertexCount();
    for (auto* array : {&x_hat, &v_hat, &start_positions, &start_velocities, &uncorrected, &displacement})
      array->resize(n);
    held.resize(n);
    penetrations.reserve(m.external_vertices.size());
  }

  void start() { started = clock ? clock() : 0; }
  void spent(Stage stage, StepReport& report) {
    if (!clock) return;
    const double now = clock();
    report.seconds[stage] += now - started;
    started = now;
  }
};

StepContext::StepContext(const HairMesh& mesh, double (*clock)()) : parts_(std::make_unique<Parts>(mesh, clock)) {}
StepContext::~StepContext() = default;
StepContext::StepContext(StepContext&&) noexcept = default;
StepContext& StepContext::operator=(StepContext&&) noexcept = default;

void StepContext::refreshGradually(bool on) {
  parts_->gradual = on;
}

const char* stageName(Stage stage) {
  constexpr const char* kNames[kStageCount] = {"forces", "solve", "collision", "minimization", "other"};
  return kNames[stage];
}

namespace {

using Parts = StepContext::Parts;

// Derived values follow the parameters that they depend on.
void refreshModel(const SimParams& params, Parts& parts) {
  const auto tell = [&](auto&& take) {
    if (parts.single_solver) take(*parts.single_solver);
    if (parts.double_solver) take(*parts.double_solver);
  };
  const auto setModel = [&](auto& solver) { solver.setModel(*parts.mesh, parts.material.model, params.density); };
  if (!parts.has_model || !sameMaterial(params, parts.params)) {
    if (parts.has_model && parts.gradual) {
      parts.material.follow(params);
    } else {
      parts.material.set(params);
    }
    parts.has_model = true;
    tell(setModel);
  } else if (parts.material.work(kBalanceSlices)) {
    tell([&](auto& solver) { solver.setRestShifts(*parts.mesh, parts.material.model); });
  }
  parts.params = params;
  const auto ready = [&](auto& solver) {
    if (!solver) {
      solver.emplace(*parts.mesh, parts.pattern);
      setModel(*solver);
    }
    solver->gradual = parts.gradual;
  };
  if (params.precision == Precision::kDouble)
    ready(parts.double_solver);
  else
    ready(parts.single_solver);
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
  if (params.precision == Precision::kDouble) {
    parts.double_solver->solve(*parts.mesh, params, base, parts.clock, state.contacts, state.velocities, report);
  } else {
    parts.single_solver->solve(*parts.mesh, params, base, parts.clock, state.contacts, state.velocities, report);
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

// Holds the corrected vertices, resting contacts and roots, and lets the others follow.
void minimizeAround(double tolerance, Parts& parts, HairState& state, StepReport& report) {
  const std::size_t n = state.positions.size();
  report.minimization_iterations +=
      minimizeDeformation(parts.laplacian, parts.held, tolerance, parts.minimization, parts.displacement);
  for (std::size_t i = 0; i < n; ++i) {
    if (!parts.held[i]) state.positions[i] += parts.displacement[i];
  }
}

// A corrected vertex keeps the collider's normal velocity and loses tangential speed to friction; the new contact
// constrains the next solve.
void enterContact(const SimParams& params, const StepInput& input, const Penetration& hit, HairState& state) {
  const Ellipsoid& e = input.ellipsoids[hit.collider];
  Vec3& v = state.velocities[hit.vertex];
  const Vec3 relative = v - surfaceVelocity(e, hit.target);
  const double approach = -relative.dot(hit.normal);
  if (approach > 0) {
    const Vec3 slip = relative + approach * hit.normal;
    const double speed = slip.norm();
    const double loss = std::min(speed, params.friction * approach);
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

// Position correction, deformation minimization, velocity update (figures 4 and 5 of the paper). Minimization may push
// other external vertices in, which the paper leaves to future work: the rounds go on with these held as well, and a
// last correction without minimization leaves nothing inside.
void resolvePenetrations(const SimParams& params, const StepInput& input, double dt, Parts& parts, HairState& state,
                         StepReport& report) {
  const HairMesh& mesh = *parts.mesh;
  if (parts.penetrations.empty()) return;
  for (const Penetration& hit : parts.penetrations)
    report.max_penetration = std::max(report.max_penetration, hit.depth);
  std::fill(parts.held.begin(), parts.held.end(), 0);
  for (int c = 0; c < mesh.columnCount(); ++c) parts.held[mesh.shape.column_first[c]] = 1;
  for (const Contact& contact : state.contacts) parts.held[contact.vertex] = 1;
  parts.uncorrected = state.positions;
  for (int round = 0; round < kCorrectionRounds && !parts.penetrations.empty(); ++round) {
    std::fill(parts.displacement.begin(), parts.displacement.end(), Vec3::Zero());
    for (const Penetration& hit : parts.penetrations) {
      parts.displacement[hit.vertex] = hit.target - state.positions[hit.vertex];
      parts.held[hit.vertex] = 1;
      state.positions[hit.vertex] = hit.target;
      enterContact(params, input, hit, state);
      ++report.corrected;
    }
    parts.spent(kStageCollision, report);
    if (params.minimize_deformation) minimizeAround(1e-3, parts, state, report);
    parts.spent(kStageMinimization, report);
    findPenetrations(mesh, input.ellipsoids, params.contact_offset, state.positions, parts.penetrations);
  }
  for (const Penetration& hit : parts.penetrations) {
    state.positions[hit.vertex] = hit.target;
    enterContact(params, input, hit, state);
    ++report.corrected;
  }
  // Vertices that followed take the velocity of their displacement, no more than the depenetration speed: a deep
  // overlap must not become a kick.
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (mesh.isRoot(static_cast<int>(i))) continue;
    const Vec3 moved = state.positions[i] - parts.uncorrected[i];
    const double speed = moved.norm() / dt;
    if (speed <= 0) continue;
    if (!parts.held[i]) state.velocities[i] += moved * (std::min(speed, params.max_depenetration) / (speed * dt));
    // The two-step history of a corrected vertex restarts, as if it had come here at its present velocity.
    state.previous_positions[i] = state.positions[i] - dt * state.velocities[i];
    state.previous_velocities[i] = state.velocities[i];
  }
  const auto order = [](const Contact& a, const Contact& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.collider < b.collider;
  };
  std::sort(state.contacts.begin(), state.contacts.end(), order);
}

// What was handed over: a state that something outside of the step has spoilt is healed before it spoils the rest.
void guardGiven(const StepInput& input, Parts& parts, HairState& state, StepReport& report) {
  Trouble trouble;
  trouble.given = true;
  heal(*parts.mesh, input.roots, parts.good, state, trouble);
  report.recoveries += trouble.ailment != Ailment::kNone;
  report.trouble = trouble;
}

// What the step made of it: where that is ill, the step's start comes back.
void guardMade(Parts& parts, const StepInput& input, HairState& state, StepReport& report) {
  Trouble trouble;
  const HairMesh& mesh = *parts.mesh;
  bool fine = true;
  for (int i = 0; i < mesh.vertexCount() && fine; ++i) fine = examine(mesh, state, i) == Ailment::kNone;
  if (fine) return;
  parts.plain_positions.clear();
  for (const Vec3& x : state.positions) parts.plain_positions.push_back({x.x(), x.y(), x.z()});
  GoodState start{parts.start_positions, parts.start_velocities};
  heal(mesh, input.roots, start, state, trouble);
  if (trouble.vertex >= 0) nameForce(parts.model, parts.plain_positions, trouble);
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
  return {input.roots, parts.standing, input.time};
}

}  // namespace

StepReport advance(const HairMesh& mesh, const SimParams& params, const StepInput& given, double dt,
                   StepContext& context, HairState& state) {
  Parts& parts = context.parts();
  StepReport report;
  parts.start();
  refreshModel(params, parts);
  guardGiven(given, parts, state, report);
  const StepInput input = carryOverJump(params, given, dt, parts, state, report);
  parts.start_positions = state.positions;
  parts.start_velocities = state.velocities;
  carryContacts(input.ellipsoids, params, dt, state);
  const StepBase base = integratorBase(params, input, dt, state, parts);
  rootsFollowScalp(input, base, mesh, state);
  parts.spent(kStageOther, report);

  solveVelocities(params, base, parts, state, report);
  parts.start();
  integratePositions(input, base, dt, mesh, parts, state);
  guardMade(parts, input, state, report);
  parts.spent(kStageOther, report);

  if (params.collide) {
    findPenetrations(mesh, input.ellipsoids, params.contact_offset, state.positions, parts.penetrations);
    resolvePenetrations(params, input, dt, parts, state, report);
    parts.spent(kStageCollision, report);
  }
  parts.good.positions = state.positions;
  parts.good.velocities = state.velocities;
  report.contacts = static_cast<int>(state.contacts.size());
  return report;
}

double mechanicalEnergy(const HairMesh& mesh, const SimParams& params, StepContext& context, const HairState& state) {
  Parts& parts = context.parts();
  refreshModel(params, parts);
  parts.plain_positions.resize(state.positions.size());
  double energy = 0;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Vec3 &x = state.positions[i], &v = state.velocities[i];
    parts.plain_positions[i] = {x.x(), x.y(), x.z()};
    energy += params.density * mesh.vertex_volume[i] * (0.5 * v.squaredNorm() + params.gravity * x.y());
  }
  return energy + evaluate<double>(parts.model, parts.plain_positions, {});
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
