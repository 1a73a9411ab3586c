// State validation: finds values that are not finite or absurd, names the place and the force, and restores the last
// good state at these vertices alone. Teleports share the roots' speed.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "sim/forces/model.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"

namespace sim {

enum class StateFault { kNone, kNotFinite, kFarAway, kTooFast, kOffScalp };

// The fault found in a step, for the log. Of several vertices the first is named.
struct FaultReport {
  StateFault fault = StateFault::kNone;
  bool given = false;  // in the state as it was handed over, not in what the step made of it
  int vertex = -1, column = -1, layer = -1;
  const char* force = "";  // the force kind that pulls hardest there
  int element = -1;        // its number within the kind
  int vertices = 0;        // that were repaired
};

// One line for the log, without the line's end.
std::string faultText(const FaultReport& fault_report);

// What is wrong with a vertex: a value that is not finite, a place farther from its column's root than hair of this
// length can be thrown, a speed against the root that nothing in a scene has.
StateFault examine(const HairMesh& mesh, const HairState& state, int vertex);

// What a repair puts back: one value per vertex, or none.
struct KeptState {
  std::span<const Vec3> positions, velocities;  // m, m/s
};

// Repairs every vertex of `state` that has a fault. Its position becomes the good one, moved rigidly with the roots;
// half of the good velocity against the root is kept. The other vertices keep every bit. A root with a fault, or away
// from where `roots` (m, one per column, where the scalp takes them) has it among the others, is brought there. An
// empty `good` stands for the rest shape. Counts and names into `fault_report`.
void repair(const HairMesh& mesh, std::span<const Vec3> roots, const KeptState& good, HairState& state,
            FaultReport& fault_report);

// Names the element at the vertex named in `fault_report` whose force is largest, or not finite, at positions `x` (m).
void nameForce(const ForceModel<double>& model, std::span<const V3<double>> x, FaultReport& fault_report);

// Mean speed (m/s) of the columns' roots from where `state` has them to `roots` within dt.
double rootSpeed(const HairMesh& mesh, std::span<const Vec3> roots, double dt, const HairState& state);

}  // namespace sim
