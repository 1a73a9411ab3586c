#include "sim/implicit_solve.h"

#include <algorithm>
#include <cmath>

#include "sim/linear/vector_kernels.h"

namespace sim {
namespace {

constexpr int kContactRounds = 4;  // solves of one linear system while contacts release or start to slide
constexpr int kLineSearchSteps = 6;
constexpr int kBatchesARound = 3;  // of answers to contacts; what is still missing comes with the steps to come
// Where the direct factor can be corrected for only a part of the contacts at the price of these, so many iterations
// are tried before the rest is paid for.
constexpr int kUncorrectedIterations = 10;
constexpr Solver kAlternative = Solver::kTwoLevel;
// What an application of a preconditioner costs, in products with the matrix: the warped factor by the ratio of its
// blocks to the matrix's (measured on meshes of 361 and 2,268 vertices), and the two levels.
constexpr double kFactorCost = 0.9, kTwoLevelCost = 1.8;
// A relative residual in the norm of the two levels says less of the error than one in the factor's.
constexpr double kTwoLevelShare = 0.9;
// Nor is what they make of a residual the error itself, as with the whole factor, but less by up to an order.
constexpr double kTwoLevelNear = 0.1;
// Roots that stop or start within a step put hundreds of joules into the first residual, and a solve that leaves a
// thousandth of that raises the hair's energy. What it may leave is measured against no more than so many times what
// the hair's weight and motion are worth: with 10 a walk takes as many iterations as without the bound, a jump at four
// times its speed a fifth more; with 100 hair still gained energy.
constexpr double kFullStart = 10;
// s: a shorter step may be off by less, so that the acceleration it neglects stays the same. With one tolerance for
// all, a step of 1/480 s passed over half a metre per second squared: resting hair went on at 0.1 m/s.
constexpr double kFullTolerance = 1.0 / 60;
constexpr double kThrownBack = 0.5;  // m/s, that is worth solving again with the contact held
constexpr double kStaleRatio = 3;  // of h (h + damping): BDF2's start-up step shares its factor with the steps after it
constexpr double kStaleMass = 1.5;   // of 1 + h drag: the air is thick while the hair settles
constexpr int kSlices = 30;          // steps over which a new rest factor is spread
constexpr double kSameSpeed = 1e-5;  // m/s, that rounding may leave between a velocity and what its constraints ask

template <class T>
V3<T> cast(const Vec3& p) {
  return {static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z())};
}
template <class T>
Vec3 widen(const V3<T>& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}
template <class T>
M3<T> cast(const Eigen::Matrix3d& m) {
  M3<T> out;
  for (int k = 0; k < 9; ++k) out.m[k] = static_cast<T>(m(k / 3, k % 3));
  return out;
}

// Coulomb's law after a solve, by the reaction (N) and the velocity (m/s) that it left at each contact. Returns whether
// any contact changed.
bool updateContacts(double friction, double h, std::vector<Contact>& contacts, const auto& massAt,
                    const auto& reactionAt, const auto& velocityAt) {
  bool changed = false;
  for (Contact& contact : contacts) {
    const int i = contact.vertex;
    const FrictionLaw law{friction, h, 0.5 * massAt(i) * kThrownBack * kThrownBack};
    changed |= updateSticking(law, reactionAt(i), velocityAt(i), contact);
  }
  return std::erase_if(contacts, [](const Contact& c) { return c.pressure < 0; }) > 0 || changed;
}

}  // namespace

template <class T>
ImplicitSolver<T>::ImplicitSolver(const HairMesh& mesh, const BlockPattern& pattern)
    : layout(mesh),
      column_pattern(mesh, layout),
      model(mesh, layout, column_pattern),
      matrix(layout, column_pattern),
      product(layout),
      packed_x(layout),
      packed_v(layout),
      packed_force(layout),
      preconditioner(mesh, pattern),
      guess(mesh.vertexCount()) {
  const int n = mesh.vertexCount();
  for (auto* array : {&x, &v, &trial, &force, &rhs, &velocity_step}) array->resize(n);
  mass.resize(n), inverse_mass_dt.resize(n);
  scratch.resize(n);
  filter.vertices.reserve(n), filter.keep.reserve(n), constraints.reserve(n), touched.reserve(n);
}

template <class T>
void ImplicitSolver<T>::setModel(const HairMesh& mesh, const ForceModel<double>& source, double density) {
  model.setElements(mesh, layout, source);
  hair_mass = 0;
  for (int i = 0; i < mesh.vertexCount(); ++i) {
    mass[i] = static_cast<T>(density * mesh.vertex_volume[i]);
    hair_mass += density * mesh.vertex_volume[i];
  }
  rest_outdated = true;
  layer_age.forget(), patch_age.forget();
}

template <class T>
void ImplicitSolver<T>::setRestShifts(const HairMesh& mesh, const ForceModel<double>& source) {
  model.setElements(mesh, layout, source);
}

// Packs positions and velocities and runs the kernels.
template <class T>
T ImplicitSolver<T>::evaluateForces(std::span<const V3<T>> at, ColumnEvaluation<T> out,
                                    std::span<const V3<T>> velocities) {
  packed_x.pack(layout, at);
  if (!velocities.empty()) {
    packed_v.pack(layout, velocities);
    out.velocity = &packed_v;
  }
  return evaluate<T>(model, layout, packed_x, out);
}

template <class T>
void ImplicitSolver<T>::assembleRest(const HairMesh& mesh, const FactorTerms& terms) {
  const Vec3 origin = mesh.shape.positions[0];
  for (std::size_t i = 0; i < x.size(); ++i) trial[i] = cast<T>(Vec3(mesh.shape.positions[i] - origin));
  matrix.setZero();
  ColumnEvaluation<T> out;
  out.matrix = &matrix;
  out.matrix_scale = static_cast<T>(terms.stiffness());
  out.tension_scale = static_cast<T>(terms.h * terms.h);
  evaluateForces(trial, out, {});
  matrix.addMass(static_cast<T>(terms.mass()), mass);
}

template <class T>
bool ImplicitSolver<T>::factored(Solver solver) const {
  return solver == Solver::kWarped && static_cast<int>(x.size()) <= kMaxFactored;
}

// The factor of the rest shape's matrix, for the warped preconditioner. A stale factor stays a valid preconditioner, so
// it is made anew only when the material has changed, or the terms of the matrix by more than the ratios below; and it
// serves while the new one is made in slices. Returns whether one was made, or a slice of it.
template <class T>
bool ImplicitSolver<T>::refreshRestFactor(const HairMesh& mesh, const SimParams& params, double h) {
  const FactorTerms wanted{h, params.damping, params.air_drag};
  const auto near = [](double a, double b, double ratio) { return a < ratio * b && b < ratio * a; };
  const bool compact = params.precision == Precision::kMixed;
  const bool usable = rest_terms.h > 0 && rest_compact == compact;
  if (usable && gradual && preconditioner.restMatrixPending()) {
    if (preconditioner.continueRestMatrix(kSlices, constraints)) rest_terms = coming_terms;
    return true;
  }
  if (usable && !rest_outdated && near(wanted.stiffness(), rest_terms.stiffness(), kStaleRatio) &&
      near(wanted.mass(), rest_terms.mass(), kStaleMass)) {
    return false;
  }
  assembleRest(mesh, wanted);
  rest_outdated = false;
  if (usable && gradual && preconditioner.restFactorFine()) {
    preconditioner.beginRestMatrix(matrix);
    coming_terms = wanted;
    return true;
  }
  preconditioner.setRestMatrix(matrix, compact);
  rest_terms = wanted;
  rest_compact = compact;
  return true;
}

// Matrix, right-hand side of A v = rhs at the current x (and v, unless the linearization is `at_start`, the paper's).
template <class T>
void ImplicitSolver<T>::assemble(const SimParams& params, const StepBase& base, bool at_start) {
  const std::size_t n = x.size();
  const T h = static_cast<T>(base.h), drag = static_cast<T>(params.air_drag), tau = static_cast<T>(params.damping);
  const V3<T> wind = cast<T>(base.wind), gravity{0, static_cast<T>(-params.gravity), 0};
  matrix.setZero();
  packed_force.setZero();
  ColumnEvaluation<T> out;
  out.force = &packed_force;
  out.matrix = &matrix;
  out.matrix_scale = h * (h + tau);
  out.tension_scale = h * h;
  out.damping = tau;
  evaluateForces(x, out, at_start ? std::span<const V3<T>>() : std::span<const V3<T>>(v));
  packed_force.unpack(layout, force);
  matrix.addMass(T(1) + h * drag, mass);
  if (!at_start) multiply<T>(matrix, product, v, rhs);
  for (std::size_t i = 0; i < n; ++i) {
    const T m = mass[i];
    const V3<T> v_hat = cast<T>(base.v_hat[i]);
    V3<T> b = m * v_hat + h * (force[i] + m * (gravity + drag * wind));
    if (!at_start) b += rhs[i] - ((T(1) + h * drag) * m) * v[i];
    rhs[i] = b;
  }
}

// Sum of |r|^2 / m over the free directions at the current x, r being the residual of the step's nonlinear equation.
// With damping the step has no potential to descend (the damping forces follow the moving gradients), so the line
// search goes by this.
template <class T>
double ImplicitSolver<T>::residualSquare(const SimParams& params, const StepBase& base) {
  const T h = static_cast<T>(base.h), drag = static_cast<T>(params.air_drag);
  const V3<T> wind = cast<T>(base.wind), gravity{0, static_cast<T>(-params.gravity), 0};
  packed_force.setZero();
  ColumnEvaluation<T> out;
  out.force = &packed_force;
  out.damping = static_cast<T>(params.damping);
  evaluateForces(x, out, v);
  packed_force.unpack(layout, force);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const V3<T> outer = gravity - drag * (v[i] - wind);
    force[i] = mass[i] * (v[i] - cast<T>(base.v_hat[i])) - h * (force[i] + mass[i] * outer);
  }
  filter.apply(force);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += static_cast<double>(dot(force[i], force[i]) / mass[i]);
  return sum;
}

// Filter, constraints and friction (in `trial`, which else is the right-hand side) of the contacts as they now are, and
// velocities that meet them. Returns whether one had to be moved for that: on a restart the constraints have only
// loosened and none is, but where a vertex lies in a crease and one of its contacts let go, what the other prescribes
// is not what both did. Else, on a restart, the residual of the solve follows.
template <class T>
bool ImplicitSolver<T>::setContactConstraints(const HairMesh& mesh, const SimParams& params, const StepBase& base,
                                              std::span<const Contact> contacts, SolveStart start) {
  constraints.clear();
  constrainContacts(contacts, constraints);
  constrainPinned(base.pins, base.x_hat, base.h, constraints);
  filter.clear();
  for (int c = 0; c < mesh.columnCount(); ++c) {
    filter.vertices.push_back(mesh.shape.column_first[c]);
    filter.keep.push_back(M3<T>{});
  }
  bool moved = false;
  for (const VertexConstraint& constraint : constraints) {
    filter.vertices.push_back(constraint.vertex);
    filter.keep.push_back(cast<T>(constraint.keep));
    V3<T>& speed = v[constraint.vertex];
    const V3<T> met = filter.keep.back() * speed + cast<T>(constraint.prescribed), by = met - speed;
    if (start == SolveStart::kRestart && dot(by, by) <= kSameSpeed * kSameSpeed) continue;
    speed = met;
    moved = true;
  }
  const bool restart = start == SolveStart::kRestart;
  for (const int i : touched) {
    if (restart) scratch.r[i] -= trial[i];
    trial[i] = rhs[i];
  }
  // Kinetic friction of sliding contacts, from the pressure of the last solve.
  for (const Contact& contact : contacts) {
    if (contact.sticks || contact.pressure <= 0) continue;
    trial[contact.vertex] += cast<T>(Vec3(base.h * params.friction * contact.pressure * contact.friction_direction));
  }
  for (const int i : touched) {
    if (restart) scratch.r[i] += trial[i];
  }
  return moved;
}

template <class T>
void ImplicitSolver<T>::setResidual() {
  multiply<T>(matrix, product, v, scratch.r);
  for (std::size_t i = 0; i < v.size(); ++i) scratch.r[i] = trial[i] - scratch.r[i];
}

// The paper's setting is what the paper says, and a direct solve is done in one iteration.
template <class T>
bool ImplicitSolver<T>::looksBack(const SimParams& params) const {
  return params.solver != Solver::kPaper && params.solver != Solver::kDirect;
}

// The residual at the present v, and at a nearer one where earlier steps tell of it. Returns the head start of that.
template <class T>
double ImplicitSolver<T>::beginSolve(const SimParams& params) {
  setResidual();
  scratch.deflation = {};
  if (!looksBack(params)) return 0;
  const ColumnOperator<T> a{matrix, product};
  if (unfinished) guess.shorten(a, filter, v, scratch.r);
  const double gained = guess.improve(a, filter, v, scratch.r);
  scratch.deflation = guess.deflation();
  // Only near to the inverse is a preconditioner's norm of the residual the energy norm of the error.
  const Solver kind = preconditioner.kind();
  return kind == Solver::kWarped || kind == Solver::kTwoLevel ? gained : 0;
}

// The runs of PCG on one linear system, one after the other as its constraints change.
template <class T>
struct ImplicitSolver<T>::BudgetedSolve {
  ImplicitSolver& solver;
  const SimParams& params;
  bool warped;  // the whole rest factor is at hand, and the plan chooses between it and its stand-in
  PreconditionerChoice::Plan plan;
  StopRule<T> stop;
  SolveReport total = {};
  double cost = 0;  // products with the matrix
  bool overrun = false;

  double applicationCost() const {
    const auto& preconditioner = solver.preconditioner;
    return preconditioner.kind() == Solver::kWarped ? kFactorCost * preconditioner.restFactorRatio() : kTwoLevelCost;
  }

  void runSome(int most, SolveStart start) {
    const Solver kind = solver.preconditioner.kind();
    const bool exact = kind == Solver::kWarped || kind == Solver::kDirect, levels = kind == Solver::kTwoLevel;
    const double shorter = std::min(1.0, stop.h / kFullTolerance);
    stop.displacement = (exact ? 1 : levels ? kTwoLevelNear : 0) * shorter * shorter * params.displacement_tolerance;
    stop.foresee = exact;
    stop.relative = (levels ? kTwoLevelShare : 1) * params.tolerance;
    stop.max_iterations = most;
    const int before = total.iterations;
    total = solveModifiedPcg<ColumnOperator<T>>({solver.matrix, solver.product}, solver.trial, solver.filter,
                                                solver.preconditioner, stop, solver.scratch, solver.v, start);
    cost += total.iterations + applicationCost() * total.applications;
    total.iterations += before;
  }

  // Within the budget of the plan; beyond it the other preconditioner takes over, once.
  void run(int most, SolveStart start) {
    if (!warped || overrun) return runSome(most, start);
    const double left = (plan.budget - cost) / (1 + applicationCost());
    const int affordable = left < most ? std::max(1, static_cast<int>(left)) : most;
    runSome(affordable, start);
    if (total.converged || affordable >= most) return;
    overrun = true;
    solver.preconditioner.update(solver.matrix, plan.cheap ? params.solver : kAlternative, {}, solver.constraints);
    solver.preconditioner.setConstraints(solver.constraints, kBatchesARound);
    runSome(params.max_iterations, SolveStart::kExchange);
  }
};

// J: what the hair's motion and weight are worth.
template <class T>
double ImplicitSolver<T>::energyScale(const HairMesh& mesh) const {
  double scale = 9.81 * hair_mass * mesh.hair_length;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!mesh.isRoot(static_cast<int>(i))) scale += static_cast<double>(mass[i] * dot(v[i], v[i]));
  }
  return scale;
}

template <class T>
SolveReport ImplicitSolver<T>::solveLinear(const HairMesh& mesh, const SimParams& params, const StepBase& base,
                                           std::vector<Contact>& contacts) {
  // The warped factor, or its stand-in (see preconditioner_choice.h).
  const bool warped = factored(params.solver);
  BudgetedSolve run{*this, params, warped, warped ? choice.begin() : PreconditionerChoice::Plan{}, {}};
  run.stop.acceleration = params.acceleration_tolerance;
  run.stop.inverse_mass_dt = inverse_mass_dt;
  run.stop.h = base.h;
  if (looksBack(params)) run.stop.most_first = kFullStart * energyScale(mesh);
  const bool stand_in = warped ? run.plan.cheap : params.solver == Solver::kWarped;
  const Solver first = stand_in ? kAlternative : params.solver;
  const FactorTerms terms{base.h, params.damping, params.air_drag};
  const bool same = first == Solver::kTwoLevel && terms == layer_terms;
  const typename Preconditioner<T>::Keep kept{same && layer_age.serves(), same && patch_age.serves()};
  touched.clear();
  for (const Contact& contact : contacts) {
    if (touched.empty() || touched.back() != contact.vertex) touched.push_back(contact.vertex);
  }
  std::copy(rhs.begin(), rhs.end(), trial.begin());
  SolveStart start = SolveStart::kPrepared;
  for (int round = 0; round < kContactRounds; ++round) {
    const bool moved = setContactConstraints(mesh, params, base, contacts, start);
    // Of the first round: where contacts let go, what P leaves out are directions that hardly matter any more.
    if (round == 0) preconditioner.update(matrix, first, kept, constraints);
    const bool complete = preconditioner.setConstraints(constraints, kBatchesARound);
    if (round == 0) {
      run.stop.head_start = beginSolve(params);
    } else if (moved) {
      setResidual();
      scratch.deflation = {};  // not all of it lies within what is free now
    }
    const bool pay = !complete && params.solver == Solver::kDirect;
    run.run(pay ? std::min(kUncorrectedIterations, params.max_iterations) : params.max_iterations, start);
    if (!run.total.converged && pay) {
      preconditioner.setConstraints(constraints);
      run.run(params.max_iterations, SolveStart::kRestart);
    }
    const auto reactionAt = [&](int i) { return Vec3(widen<T>(trial[i] - rhs[i] - scratch.r[i]) / base.h); };
    const auto velocityAt = [&](int i) { return widen<T>(v[i]); };
    const auto massAt = [&](int i) { return static_cast<double>(mass[i]); };
    if (contacts.empty() || !updateContacts(params.friction, base.h, contacts, massAt, reactionAt, velocityAt)) break;
    start = SolveStart::kRestart;
  }
  // A factor that served to its end is as old as the solves since it was made. Solves by other preconditioners age it
  // without telling by how much.
  if (first == Solver::kTwoLevel && preconditioner.kind() == Solver::kTwoLevel && !run.overrun) {
    layer_age.count(kept.factors, run.total.iterations);
    patch_age.count(kept.patches, run.total.iterations);
    layer_terms = terms;
  } else {
    layer_age.forget(), patch_age.forget();
  }
  if (warped) choice.end(run.plan, run.cost, run.overrun);
  unfinished = !run.total.converged;
  return run.total;
}

// Positions at the step's end if the velocities were these, relative to one root: single precision keeps micrometres
// wherever the character stands.
template <class T>
void ImplicitSolver<T>::place(const StepBase& base, std::span<const V3<T>> speed) {
  const Vec3 origin = base.x_hat[0];
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = cast<T>(Vec3(base.x_hat[i] - origin));
    if (!speed.empty()) x[i] += static_cast<T>(base.h) * speed[i];
  }
}

template <class T>
void ImplicitSolver<T>::beginStep(const SimParams& params, const StepBase& base, std::span<const Vec3> velocities,
                                  std::vector<Contact>& contacts) {
  for (std::size_t i = 0; i < v.size(); ++i) {
    v[i] = cast<T>(velocities[i]);
    inverse_mass_dt[i] = T(1) / (mass[i] * static_cast<T>(base.h));
  }
  for (Contact& contact : contacts) {
    const double mobility = base.h / static_cast<double>(mass[contact.vertex]);
    chooseSticking(params.friction, mobility, velocities[contact.vertex], contact);
  }
}

// A Newton iterate goes back towards the one before, which is in velocity_step, until the residual is not above `most`
// (negative: wherever it is). Returns the largest change (m/s) that the whole iterate makes.
template <class T>
double ImplicitSolver<T>::backtrack(const SimParams& params, const StepBase& base, double most) {
  T largest = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    trial[i] = v[i] - velocity_step[i];
    largest = std::max(largest, dot(trial[i], trial[i]));
  }
  place(base, v);
  T step = 1;
  for (int k = 0; k < kLineSearchSteps && most >= 0 && residualSquare(params, base) > most; ++k) {
    step *= T(0.5);
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = velocity_step[i] + step * trial[i];
    place(base, v);
  }
  return std::sqrt(static_cast<double>(largest));
}

// N, of the firm pins.
template <class T>
double ImplicitSolver<T>::largestReaction(const StepBase& base) const {
  double largest = 0;
  for (const PinnedVertex& pin : base.pins) {
    if (pin.firm()) largest = std::max(largest, widen(scratch.r[pin.vertex]).norm() / base.h);
  }
  return largest;
}

template <class T>
void ImplicitSolver<T>::solve(const HairMesh& mesh, const SimParams& params, const StepBase& base, StageClock& clock,
                              std::vector<Contact>& contacts, std::span<Vec3> velocities, StepReport& report) {
  const bool linearized = params.integrator == Integrator::kLinearizedEuler;
  const bool newton = params.integrator == Integrator::kImplicitEuler;
  const bool at_rest = factored(params.solver);
  beginStep(params, base, velocities, contacts);
  if (at_rest && refreshRestFactor(mesh, params, base.h)) report.refreshes.skipped = 0;
  const int most = newton ? std::max(1, params.newton_iterations) : 1;
  for (int iteration = 0; iteration < most; ++iteration) {
    place(base, linearized ? std::span<const V3<T>>() : std::span<const V3<T>>(v));
    assemble(params, base, linearized);
    if (at_rest) preconditioner.updateRotations(x);
    preconditioner.setPositions(x);
    clock.spent(kStageForces, report);
    // The first iterate does not yet meet the constraints: nothing to compare with.
    const double before = newton && iteration > 0 ? residualSquare(params, base) : -1;
    if (newton) std::copy(v.begin(), v.end(), velocity_step.begin());
    const SolveReport linear = solveLinear(mesh, params, base, contacts);
    report.solver_iterations += linear.iterations;
    report.residual = linear.relative_residual;
    report.residual_acceleration = linear.residual_acceleration;
    report.pin_force = largestReaction(base);
    report.converged = linear.converged;
    ++report.newton_iterations;
    if (newton && backtrack(params, base, before) <= params.newton_tolerance) iteration = most;
    clock.spent(kStageSolve, report);
  }
  if (looksBack(params)) guess.record([&](std::size_t i) { return v[i] - cast<T>(velocities[i]); });
  for (std::size_t i = 0; i < v.size(); ++i) velocities[i] = widen(v[i]);
  clock.spent(kStageSolve, report);
}

template struct ImplicitSolver<float>;
template struct ImplicitSolver<double>;

}  // namespace sim
