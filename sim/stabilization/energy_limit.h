// The energy guard: no step makes energy out of nothing.
//
// One linearized step has no bound where the hair moves by more than the forces stay linear over: hair left a metre
// behind its roots is flung ahead by two. Seen from the roots, which carry the hair along rigidly, what a step ends
// with can be no more than what it began with: with u the velocity of being carried along, from x to x_c = x + dt u,
//   E(x') + 1/2 m |v' - u|^2  <=  E(x_c) + 1/2 m |v - u|^2 + work of the air and of the bodies in contact.
// The term in v - u holds the inertia forces of any motion of the roots, exactly. A step that ends above is taken back
// towards x_c until its potential energy fits, then slowed until the sum does: the hair is carried along more rigidly
// instead of being stretched beyond measure.
//
// A pin's work is counted as its target's motion before the hair's: its spring is part of E, with the target where the
// step ends; and x_c of a vertex that is pinned firmly is its target, as that of a root is where the scalp takes it.
//
// A gentle step of hair as styles have it is near to linear, and not looked at. Never near to linear is hair that hangs
// folded because its load strains its walls by more than a fifth, or that is so much stiffer one way than another that
// it buckles. Hair that was stopped in the step before does in this one what it was kept from.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sim/contact/colliders.h"
#include "sim/forces/stored_energy.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"

namespace sim {

// The step that was taken; its end is in the state.
struct TakenStep {
  const HairMesh& mesh;
  const SimParams& params;
  const ForceModel<double>& model;
  std::span<const Vec3> positions, velocities;  // m, m/s, at its start
  double dt;                                    // s
  Vec3 wind;                                    // m/s
  std::span<const PinnedVertex> pins{};         // that hold
  bool restarted = false;                       // the hair was stopped, taken back or set before it
};

struct EnergyLimit {
  std::vector<Vec3> carried;
  StoredEnergy stored;
  std::optional<double> carried_energy;  // J, potential, of the hair as the roots carry it in this step
  int energies = 0;                      // potential energies computed in this step
  explicit EnergyLimit(const HairMesh& mesh);
};

// Does nothing to a step that leaves a value not finite, that ends below its bound, or that is gentle, of firm hair,
// not restarted and solved to its end with the bodies of the step before (`solved`). Returns the share of the step's
// motion against the roots that was kept, 1 where all was.
double limitEnergy(const TakenStep& step, bool solved, EnergyLimit& scratch, HairState& state);

// The same for a step, gentle or not, whose contacts or self-contacts have moved vertices: what these store or lift,
// and what follows them, must be paid for by what the step began with, where the bodies touched stand still against the
// roots. In stiff hair a push of a millimetre may store more than the hair has.
double limitCorrections(const TakenStep& step, const Colliders& colliders, EnergyLimit& scratch, HairState& state);

}  // namespace sim
