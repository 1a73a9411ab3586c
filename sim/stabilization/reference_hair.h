// Hair that has come to rest in another shape than its own.
//
// A style may have more than one shape in which its forces balance: a tip caught behind its neighbours, a lock bent the
// other way. Nothing is turned over there and nothing folded, so combing out has nothing to see, and yet the hair hangs
// a centimetre off for good. What tells it is energy: when hair hangs still and touches no body, a twin is put to the
// rest shape and settles in the same air, under the same parameters and from the same roots. Where it comes to rest
// elsewhere and lower, the hair is led there as if it were combed out. Soft hair that found a shape as low as its own,
// or a lower one, is left in it.
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
  // hair; if it finds nothing lower, a second one is kept apart, for the first may have been caught behind its
  // neighbours.
  bool self_contact = false;
};

// Looks at the hair after a step. Returns whether its reference is to take one too. The memory has its size.
bool watchRest(const RestStep& step, RecoveryScratch& scratch, HairState& state);

// After the reference's step: once both hang still, has the hair guided to where the reference is, if that is elsewhere
// and lower by more than a small share of the scale. `energy`: mechanical, of a state (J).
void judgeRest(const RestStep& step, const std::function<double(const HairState&)>& energy, RecoveryScratch& scratch,
               HairState& state);

}  // namespace sim
