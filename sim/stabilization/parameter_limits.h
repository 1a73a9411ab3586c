// Parameter limits: what the parameters ask for together, held to what hair can bear.
//
// Rule for the walls: `stretch_along` is at least what bears the hair's weight, the wind and the drag within
// kMaxLoadStrain. Rule for the air: wind and gusts press no harder than kMaxWindLoad, ten weights, at which hair
// streams straight out. Beyond both no step is near to linear.
#pragma once

#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/sim_params.h"

namespace sim {

// Strain at the roots of hair that hangs by its walls alone.
inline constexpr double kMaxLoadStrain = 0.1;

inline constexpr double kMaxWindLoad = 100;  // m/s^2, of wind and gusts on hair that does not move

// How hard wind and gusts press hair that does not move, m/s^2.
double windLoad(const SimParams& params);

// `params` with no more wind than that, and the least stretch_along (Pa) that bears density, gravity, wind and drag.
// Loose particles, without walls and volume, are left as they are; so is the published step (Solver::kPaper).
SimParams limitedParameters(const HairMesh& mesh, SimParams params);

// A parameter of which a step uses another value than is set.
struct LimitedValue {
  const ParamField* field;  // its row of the table
  double used;              // in that row's unit
  const char* reason;       // for the artist, to follow the value: "to bear the hair's weight"
};

// All that limitedParameters changes, in the table's order.
std::vector<LimitedValue> limitedValues(const HairMesh& mesh, const SimParams& params);

}  // namespace sim
