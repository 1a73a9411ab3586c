#include "sim/step_work.h"

#include <algorithm>

namespace sim {
namespace {

// Units a vertex
constexpr double kSolve = 6.5, kFactors = 2.5, kCoarseSpace = 4.8, kEnergy = 2, kMinimization = 1.5;
constexpr double kSurfacePoint = 17, kContact = 85;       // units each; of a contact, what a step takes to keep it
constexpr double kSolveShare = 0.5, kFollowShare = 0.25;  // of what a budget leaves to choose
constexpr int kEnergies = 2;                              // that a step in motion computes

}  // namespace

StepWork& StepWork::operator+=(const StepWork& other) {
  solves += other.solves, iterations += other.iterations;
  factors += other.factors, coarse_spaces += other.coarse_spaces;
  energies += other.energies, minimizations += other.minimizations;
  surface_points += other.surface_points;
  return *this;
}

double workUnits(int vertices, const StepWork& work) {
  const double each = kSolve * work.solves + work.iterations + kFactors * work.factors +
                      kCoarseSpace * work.coarse_spaces + kEnergy * work.energies + kMinimization * work.minimizations;
  return vertices * each + kSurfacePoint * static_cast<double>(work.surface_points);
}

WorkBounds boundsWithin(int vertices, int contacts, double units) {
  constexpr double kMaxCount = 1e6;
  const double each = units / std::max(1, vertices) - kSolve - kFactors - kCoarseSpace - kEnergies * kEnergy;
  const double all = std::clamp(each, 0.0, kMaxCount);
  const double touching = std::min(all, kContact * contacts / vertices), left = all - touching;
  WorkBounds bounds;
  bounds.iterations = std::max(1, static_cast<int>(kSolveShare * left));
  bounds.minimizations = static_cast<int>(kFollowShare * left / kMinimization);
  bounds.surface_points = static_cast<long>((1 - kSolveShare - kFollowShare) * all * vertices / kSurfacePoint);
  return bounds;
}

}  // namespace sim
