// The reference hair: tells whether hair rests in its own shape.
//
// The forces of a style may balance in more than one shape: a tip caught behind its neighbours, a lock bent the other
// way. No element is inverted there, so inversion recovery finds nothing. The energy tells the shapes apart. When hair
// hangs still and touches no body, a reference hair starts from the rest shape under the same parameters, air and
// roots. Where the reference comes to rest elsewhere and with less energy, the hair is guided there. Hair with no more
// energy than its reference stays as it is.
#pragma once

#include <functional>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/stabilization/inversion_recovery.h"

namespace sim {

// The step that was taken.
struct RestStep {
  const HairMesh& mesh;
  double dt;     // s
  double pull;   // m/s^2, of gravity and wind: under more than hair's own weight it never hangs quite as still
  double scale;  // J, the hair's weight times its length
  // With self-contact the first reference runs through its own bundles, for their pushes may hold it as they hold the
  // hair. If it finds nothing lower, a second one is kept apart: the first may be caught behind its neighbours.
  bool self_contact = false;
};

// Looks at the hair after a step. Returns whether its reference is to take one too. The memory has its size.
bool watchRest(const RestStep& step, HairState& state);

// After the reference's step: once both hang still, has the hair guided to where the reference is, if that is elsewhere
// and lower by more than a small share of the scale. `energy`: mechanical, of a state (J).
void judgeRest(const RestStep& step, const std::function<double(const HairState&)>& energy, HairState& state);

}  // namespace sim
