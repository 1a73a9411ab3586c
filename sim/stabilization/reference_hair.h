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
#include <span>
#include <vector>

#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/stabilization/inversion_recovery.h"

namespace sim {

// What is known of a hair's rest from step to step: one per hair.
struct RestCheck {
  explicit RestCheck(const HairMesh& mesh);

  HairState reference;
  double still = 0;              // s that the hair has hung still
  double settling = -1;          // s since the twin left the rest shape; negative: there is none
  bool judged = false;           // nothing more to find out before the hair has moved
  double wait = 0, backoff = 0;  // s before it may be led again, and after the next time
  double stir = 1;               // times as fast as hair that its weight alone pulls
  // With self-contact the first twin runs through its own bundles, for their pushes may hold it as they hold the hair;
  // if it finds nothing lower, a second one is kept apart, for the first may have been caught behind its neighbours.
  bool self_contact = false, kept_apart = false;
  std::vector<Vec3> roots;  // m, scratch
};

// Looks at the hair after a step of dt (s). Returns whether its twin is to take one too. pull: m/s^2, of gravity and
// wind; under more than hair's own weight it never hangs quite as still.
bool watchRest(const HairMesh& mesh, const HairState& state, double pull, double dt, const InversionRecovery& recovery,
               RestCheck& check);

// After the twin's step: once both hang still, has the hair led to where the twin is, if that is elsewhere and lower by
// more than a small share of `scale` (J, the hair's weight times its length). `energy`: mechanical, of a state (J).
void judgeRest(const HairMesh& mesh, const HairState& state, double scale,
               const std::function<double(const HairState&)>& energy, InversionRecovery& recovery, RestCheck& check);

}  // namespace sim
