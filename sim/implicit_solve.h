// The implicit solve of a step: forces, Hessians and the constrained linear systems of the chosen integrator.
//
// One linear system serves both integrators. With v the velocity at the step's end, x = x_hat + h v its position and
// the base (x_hat, v_hat, h) chosen by the integrator (implicit Euler: x0, v0, dt; BDF2: the two-step combinations and
// 2/3 dt), a Newton step from v0 reads
//   A (v - v0) = -r(v0),   r(v) = M (v - v_hat) - h (f(x, v) + M g - c M (v - wind))
//   A = (1 + h c) M + h (h + tau) K + h^2 T
// K: sum of k g g^T over the conditions, T: the tension part of stretch, c: air drag, tau: damping time. The paper's
// linearized step (Baraff and Witkin) takes K at x0 and one solve: A v = M v0 + h (f(x0) + M g + c M wind); its damping
// terms cancel.
#pragma once

#include <span>
#include <vector>

#include "sim/contact/contact.h"
#include "sim/forces/kernels.h"
#include "sim/linear/block_jacobi.h"
#include "sim/linear/modified_pcg.h"
#include "sim/linear/solution_projection.h"
#include "sim/linear/two_level.h"
#include "sim/step_report.h"

namespace sim {

// The base of a step: x = x_hat + h v.
struct StepBase {
  std::span<const Vec3> x_hat, v_hat;    // m, m/s
  double h = 0;                          // s
  Vec3 wind = Vec3::Zero();              // m/s
  std::span<const PinnedVertex> pins{};  // those that hold
};

// What a solve in scalar type T needs: derived data and scratch.
template <class T>
struct ImplicitSolver {
  ColumnLayout layout;
  ColumnPattern column_pattern;
  ColumnModel<T> model;
  ColumnMatrix<T> matrix;
  ColumnProduct<T> product;
  ColumnField<T> packed_x, packed_v, packed_force;
  TwoLevel<T> two_level;
  BlockJacobi<T> block_jacobi;  // Solver::kPaper
  Filter<T> filter;
  SolverScratch<T> scratch;
  SolutionProjection<T> guess;
  std::vector<V3<T>> x, v, trial, force, rhs;
  std::vector<T> mass, inverse_mass_dt;
  double hair_mass = 0;          // kg
  std::vector<T> damping_share;  // see ColumnEvaluation
  std::vector<VertexConstraint> constraints;
  std::vector<int> touched;  // vertices that were in contact when the solve began
  MatrixTerms terms;         // of the present solve

  explicit ImplicitSolver(const HairMesh& mesh);
  void setModel(const HairMesh& mesh, const ForceModel<double>& source, double density);

  // Solves for the velocities at the step's end, from the guess in `velocities`, which it overwrites. Roots take the
  // velocities given there; contacts constrain their vertices, are dropped when they would pull, and stick or slide by
  // Coulomb's law. Reports iterations, residuals and stage times since the clock's last booking.
  void solve(const HairMesh& mesh, const SimParams& params, const StepBase& base, StageClock& clock,
             std::vector<Contact>& contacts, SolveMemory& memory, std::span<Vec3> velocities, StepReport& report);

 private:
  void assemble(const SimParams& params, const StepBase& base, bool at_start);
  bool setContactConstraints(const HairMesh& mesh, const SimParams& params, const StepBase& base,
                             std::span<const Contact> contacts, SolveStart start);
  void setResidual();
  double largestReaction(const StepBase& base) const;
  void assembleMatrix(std::span<const V3<T>> at, std::span<const V3<T>> velocities, const MatrixTerms& of);
  double beginSolve(const SimParams& params, bool unfinished);
  double energyScale(const HairMesh& mesh) const;
  StopRule<T> stopRule(const HairMesh& mesh, const SimParams& params, const StepBase& base) const;
  void updatePreconditioner(const SimParams& params);
  SolveReport solveLinear(const HairMesh& mesh, const SimParams& params, const StepBase& base, bool unfinished,
                          std::vector<Contact>& contacts);
  void noteTerms(const SimParams& params, const StepBase& base);
  void place(const StepBase& base, std::span<const V3<T>> speed);
  void beginStep(const SimParams& params, const StepBase& base, std::span<const Vec3> velocities,
                 std::vector<Contact>& contacts);
};

}  // namespace sim
