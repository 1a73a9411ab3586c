// Counted work of a step: the same on every machine and every run, where time is not.
#pragma once

namespace sim {

// What a step did that takes time, its reference hair and repeated corrections included.
struct StepWork {
  int solves = 0;           // each: forces, Hessians, right-hand side
  int iterations = 0;       // of Modified PCG
  int factors = 0;          // of layers and columns, made
  int coarse_spaces = 0;    // made
  int energies = 0;         // potential energies of a whole hair
  int minimizations = 0;    // iterations of deformation minimization
  long surface_points = 0;  // closest points of colliders

  StepWork& operator+=(const StepWork& other);
};

// In units of one iteration of Modified PCG at one vertex, about 0.04 microseconds. The weights are least squares fits
// to the times of steps of the nine styles; hairmesh-bench --frames-budget prints how far time strays from them.
double workUnits(int vertices, const StepWork& work);

// What a step may do so that it ends within `units`. What the work that every step has leaves is for closest points by a
// quarter; what so many contacts leave of it, for the solve by half and for minimization by a quarter. At least one
// iteration, and contacts are kept: a step with many takes longer where `units` are below that.
struct WorkBounds {
  int iterations = 0, minimizations = 0;
  long surface_points = 0;
};
WorkBounds boundsWithin(int vertices, int contacts, double units);

}  // namespace sim
