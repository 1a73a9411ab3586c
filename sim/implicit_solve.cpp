#include "sim/implicit_solve.h"

#include <algorithm>
#include <cmath>

#include "sim/linear/vector_kernels.h"

namespace sim {
namespace {

constexpr int kContactRounds = 4;  // solves of one linear system while contacts release or start to slide
// What the two levels answer to a residual is up to an order less than the error itself.
constexpr double kErrorShare = 0.1;
// Roots that stop or start within a step put hundreds of joules into the first residual, and a solve that leaves a
// thousandth of that raises the hair's energy. What it may leave is measured against no more than so many times what
// the hair's weight and motion are worth: with 10 a walk takes as many iterations as without the bound, a jump at four
// times its speed a fifth more; with 100 hair still gained energy.
constexpr double kFullStart = 10;
// s: a shorter step may be off by less, so that the acceleration it neglects stays the same. With one tolerance for
// all, a step of 1/480 s passed over half a metre per second squared: resting hair went on at 0.1 m/s.
constexpr double kFullTolerance = 1.0 / 60;
constexpr double kThrownBack = 0.5;  // m/s, that is worth solving again with the contact held
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
ImplicitSolver<T>::ImplicitSolver(const HairMesh& mesh)
    : layout(mesh),
      column_pattern(mesh, layout),
      model(mesh, layout, column_pattern),
      matrix(layout, column_pattern),
      product(layout),
      packed_x(layout),
      packed_v(layout),
      packed_force(layout),
      two_level(mesh),
      block_jacobi(mesh.vertexCount()),
      guess(mesh.vertexCount()) {
  const int n = mesh.vertexCount();
  for (auto* array : {&x, &v, &trial, &force, &rhs}) array->resize(n);
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
  damping_share.assign(mesh.damping_share.empty() ? 0 : layout.size(), T(0));
  for (std::size_t i = 0; i < mesh.damping_share.size(); ++i)
    damping_share[layout.slot[i]] = static_cast<T>(mesh.damping_share[i]);
  two_level.drop();
}

// Matrix and forces at positions and velocities; without these, the forces are those of resting hair.
template <class T>
void ImplicitSolver<T>::assembleMatrix(std::span<const V3<T>> at, std::span<const V3<T>> velocities,
                                       const MatrixTerms& of) {
  const T h = static_cast<T>(of.h), tau = static_cast<T>(of.damping);
  matrix.setZero();
  packed_force.setZero();
  packed_x.pack(layout, at);
  if (!velocities.empty()) packed_v.pack(layout, velocities);
  const ColumnField<T>* const moving = velocities.empty() ? nullptr : &packed_v;
  evaluate<T>(model, layout, packed_x, {&packed_force, &matrix, h * (h + tau), h * h, moving, tau, damping_share});
  matrix.addMass(T(1) + h * static_cast<T>(of.drag), mass);
}

// Matrix, right-hand side of A v = rhs at the current x (and v, unless the linearization is `at_start`, the paper's).
template <class T>
void ImplicitSolver<T>::assemble(const SimParams& params, const StepBase& base, bool at_start) {
  const std::size_t n = x.size();
  const T h = static_cast<T>(base.h), drag = static_cast<T>(params.air_drag);
  const V3<T> wind = cast<T>(base.wind), gravity{0, static_cast<T>(-params.gravity), 0};
  assembleMatrix(x, at_start ? std::span<const V3<T>>() : std::span<const V3<T>>(v), terms);
  packed_force.unpack(layout, force);
  if (!at_start) multiply<T>(matrix, product, v, rhs);
  for (std::size_t i = 0; i < n; ++i) {
    const T m = mass[i];
    const V3<T> v_hat = cast<T>(base.v_hat[i]);
    V3<T> b = m * v_hat + h * (force[i] + m * (gravity + drag * wind));
    if (!at_start) b += rhs[i] - ((T(1) + h * drag) * m) * v[i];
    rhs[i] = b;
  }
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

// The residual at the present v and, by default, at a nearer one that earlier steps' changes of velocity give. Returns
// the gain of that: the squared energy norm (J).
template <class T>
double ImplicitSolver<T>::beginSolve(const SimParams& params, bool unfinished) {
  setResidual();
  scratch.deflation = {};
  if (params.solver == Solver::kPaper) return 0;
  const auto a = [&](std::span<const V3<T>> d, std::span<V3<T>> q) { multiply<T>(matrix, product, d, q); };
  if (unfinished) guess.shorten(a, filter, v, scratch.r);
  const double gained = guess.improve(a, filter, v, scratch.r);
  scratch.deflation = guess.deflation();
  return gained;
}

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
StopRule<T> ImplicitSolver<T>::stopRule(const HairMesh& mesh, const SimParams& params, const StepBase& base) const {
  StopRule<T> stop;
  stop.relative = params.tolerance;
  stop.acceleration = params.acceleration_tolerance;
  stop.inverse_mass_dt = inverse_mass_dt;
  stop.h = base.h;
  stop.max_iterations = params.max_iterations;
  if (params.solver == Solver::kPaper) return stop;
  const double shorter = std::min(1.0, stop.h / kFullTolerance);
  stop.displacement = kErrorShare * shorter * shorter * params.displacement_tolerance;
  stop.most_first = kFullStart * energyScale(mesh);
  return stop;
}

template <class T>
void ImplicitSolver<T>::noteTerms(const SimParams& params, const StepBase& base) {
  terms.h = base.h, terms.damping = params.damping, terms.drag = params.air_drag;
  terms.pins.clear();
  for (const PinnedVertex& pin : base.pins) terms.pins.push_back({pin.vertex, pin.stiffness});
}

template <class T>
void ImplicitSolver<T>::updatePreconditioner(const SimParams& params) {
  if (params.solver == Solver::kPaper)
    block_jacobi.update(matrix);
  else
    two_level.update(matrix, x, constraints, terms);
}

template <class T>
SolveReport ImplicitSolver<T>::solveLinear(const HairMesh& mesh, const SimParams& params, const StepBase& base,
                                           bool unfinished, std::vector<Contact>& contacts) {
  StopRule<T> stop = stopRule(mesh, params, base);
  const auto run = [&](auto& preconditioner, SolveStart start) {
    const auto a = [&](std::span<const V3<T>> d, std::span<V3<T>> q) { multiply<T>(matrix, product, d, q); };
    return solveModifiedPcg<T>(a, trial, filter, preconditioner, stop, scratch, v, start);
  };
  touched.clear();
  for (const Contact& contact : contacts) {
    if (touched.empty() || touched.back() != contact.vertex) touched.push_back(contact.vertex);
  }
  std::copy(rhs.begin(), rhs.end(), trial.begin());
  SolveReport total;
  SolveStart start = SolveStart::kPrepared;
  for (int round = 0; round < kContactRounds; ++round) {
    const bool moved = setContactConstraints(mesh, params, base, contacts, start);
    if (round == 0) {
      updatePreconditioner(params);
      stop.head_start = beginSolve(params, unfinished);
    } else {
      two_level.follow(matrix, x, constraints, terms);
      if (moved) {
        setResidual();
        scratch.deflation = {};  // not all of it lies within what is free now
      }
    }
    const int before = total.iterations;
    stop.max_iterations = std::max(1, params.max_iterations - before);
    total = params.solver == Solver::kPaper ? run(block_jacobi, start) : run(two_level, start);
    total.iterations += before;
    const auto reactionAt = [&](int i) { return Vec3(widen<T>(trial[i] - rhs[i] - scratch.r[i]) / base.h); };
    const auto velocityAt = [&](int i) { return widen<T>(v[i]); };
    const auto massAt = [&](int i) { return static_cast<double>(mass[i]); };
    if (contacts.empty() || !updateContacts(params.friction, base.h, contacts, massAt, reactionAt, velocityAt)) break;
    start = SolveStart::kRestart;
  }
  if (params.solver != Solver::kPaper) two_level.count(total.iterations);
  return total;
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
                              std::vector<Contact>& contacts, SolveMemory& memory, std::span<Vec3> velocities,
                              StepReport& report) {
  const bool paper = params.solver == Solver::kPaper;
  const bool linearized = params.integrator == Integrator::kLinearizedEuler;
  // Both work on this hair's memory while it is solved for.
  std::swap(memory.two_level, two_level.memory);
  std::swap(memory.projection, guess.memory);
  if (paper) two_level.memory.forget();
  two_level.recall([&](std::span<const V3<T>> at, const MatrixTerms& of) -> const ColumnMatrix<T>& {
    assembleMatrix(at, {}, of);
    return matrix;
  });
  const int factors = two_level.made_factors, coarse_spaces = two_level.made_coarse;
  noteTerms(params, base);
  beginStep(params, base, velocities, contacts);
  place(base, linearized ? std::span<const V3<T>>() : std::span<const V3<T>>(v));
  assemble(params, base, linearized);
  clock.spent(kStageForces, report);
  const SolveReport linear = solveLinear(mesh, params, base, memory.unfinished, contacts);
  memory.unfinished = !linear.converged;
  ++report.solves;
  report.solver_iterations += linear.iterations;
  report.work += {.solves = 1,
                  .iterations = linear.iterations,
                  .factors = two_level.made_factors - factors,
                  .coarse_spaces = two_level.made_coarse - coarse_spaces};
  report.residual = linear.relative_residual;
  report.residual_acceleration = linear.residual_acceleration;
  report.pin_force = largestReaction(base);
  report.converged = linear.converged;
  if (!paper) guess.record([&](std::size_t i) { return v[i] - cast<T>(velocities[i]); });
  for (std::size_t i = 0; i < v.size(); ++i) velocities[i] = widen(v[i]);
  std::swap(memory.two_level, two_level.memory);
  std::swap(memory.projection, guess.memory);
  clock.spent(kStageSolve, report);
}

template struct ImplicitSolver<float>;
template struct ImplicitSolver<double>;

}  // namespace sim
