// Parameters that a hair can bear.
//
// Sliders are independent of one another, what they ask for is not: hair of a thousand kilograms a cubic metre, in a
// storm, with walls as soft as foam would be stretched to a hundred times its length. No style looks like that, and no
// step of such hair is near to linear. So the walls are taken to be at least as stiff along the hair as it takes to
// bear the hair's own weight and the wind without a visible stretch; whoever turns that slider lower finds that it does
// no more. And wind presses no harder than ten weights: hair streams straight out by then, and what comes on top only
// crushes it.
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
