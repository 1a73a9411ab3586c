// Pins of an actor: what the scene file asks for, found in its hair and figure, and posed for a step.
#pragma once

#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/files/pin_spec.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/step.h"

namespace app {

struct Actor;
struct LoadedBody;

// `joint` -1: the scene. `at`: m, in the joint's frame or the scene's.
struct ActorPin {
  int vertex = 0, joint = -1;
  Vec3 at = Vec3::Zero();
  double stiffness = 0, from = 0, until = 0;
  bool of_spec = true;  // else of a tie, a bun or an attachment
};

// Throws InputError where there is no such vertex or joint, or where the vertex is a root, which the scalp carries.
// `pose`: the present one, for what is fastened to the scene where it is at rest.
std::vector<ActorPin> findPins(const std::vector<PinSpec>& specs, const sim::HairMesh& mesh, const Character& character,
                               const Pose& pose);

// A joint that something hangs on (-1: none) and those above it are posed in every step.
void markMoving(int joint, LoadedBody& body);

// Gives the actor other pins of this kind in place of its spec's, and keeps those of ties and attachments. In the spec
// they then name their vertices, and what is fastened to the scene its place. Throws InputError as above; then nothing
// has changed.
void repin(std::vector<PinSpec> specs, Actor& actor);

// Which pins of the scene's hold one vertex at the same time, one of them firmly, so that it alone counts; empty: none.
std::string idlePinNote(const Actor& actor);

// After another rest shape: pins without a place of their own hold their vertices where those are at rest.
void followRestPins(Actor& actor);

// The pins that are on at `time` (s), as a step of dt seconds from the pose before to the present one sees them.
void posePins(const std::vector<ActorPin>& pins, const Pose& pose, const Pose& previous, double time, double dt,
              std::vector<sim::PinnedVertex>& posed);

// The same for a coarser mesh of the same style (by the nearest vertices at rest; `head`: scalp frame to world).
void pinsOfCoarse(const sim::HairMesh& fine, const sim::HairMesh& coarse, const Rigid& head,
                  const std::vector<sim::PinnedVertex>& whole, std::vector<sim::PinnedVertex>& pins);

}  // namespace app
