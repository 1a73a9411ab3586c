// The oracle: one simulated step as a careful student would write it, in double precision with Eigen's own sparse
// matrix and conjugate gradients. What sim/step and sim/implicit_solve do fast is held to it, and timed against it.
//
// Plain: the reference force model element by element, triplets into an Eigen::SparseMatrix, constraints by
// elimination, Eigen's ConjugateGradient with its diagonal preconditioner. Shared with the simulator are the element
// formulas (sim/forces), the rest state, the geometry of the colliders, and what a contact is (sim/contact/contact);
// nothing of its layouts, solvers, preconditioners, filters and factors.
#pragma once

#include <optional>

#include "sim/forces/model.h"
#include "sim/step.h"

namespace oracle {

// What is kept between steps: the pattern of coupled vertices and the elements of the present material. Refers to the
// mesh, which must outlive it. `clock` returns seconds, for stage times (nullptr: not measured).
struct PlainContext {
  explicit PlainContext(const sim::HairMesh& mesh, double (*c)() = nullptr);
  PlainContext(const PlainContext&) = delete;
  PlainContext& operator=(const PlainContext&) = delete;

  double (*clock)();
  sim::BlockPattern pattern;
  sim::BlockMatrix<double> matrix;
  sim::ForceModel<double> model;
  std::optional<sim::SimParams> made_for;
};

// As sim::advance with the linearized implicit Euler step (params.integrator, solver and precision are not looked at),
// to the relative residual params.tolerance, measured against the step's first residual in the Euclidean norm. Takes as
// many iterations as that needs: neither max_iterations nor acceleration_tolerance ends a solve. No state validation.
sim::StepReport plainAdvance(const sim::HairMesh& mesh, const sim::SimParams& params, const sim::StepInput& input,
                             double dt, PlainContext& context, sim::HairState& state);

}  // namespace oracle
