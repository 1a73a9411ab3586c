// Pins in a hand: vertices of the hair mesh fastened where they are seen, moved by a drag, and kept from one resolution
// to another. Asked for as text (pin_spec.h), so that recordings keep them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/scene/actor.h"

namespace app {

struct Demo;

// What a vertex is to be fastened to, and how.
struct PinChoice {
  std::string to = "scalp";  // a joint's name, "scalp" or "scene"
  double stiffness = PinSpec::kForever;
  double from = 0, until = PinSpec::kForever;  // s of simulated time
};

// `vertices`, and after them their likes across the parting that are not among them, each once.
std::vector<int> withLikesAcross(std::span<const int> vertices, const Actor& actor);

// The actor's pins with `vertices` pinned where they are seen now, roots left out; those that were pinned are pinned
// anew. With a mirror so are their likes across the parting, to the joint that stands across from the choice's. And
// without the vertices' pins.
std::vector<PinSpec> withPins(std::span<const int> vertices, PinChoice choice, bool mirror, const Actor& actor);
std::vector<PinSpec> withoutPins(std::span<const int> vertices, const Actor& actor);

// The vertices that the spec's pins hold, in their order.
std::vector<int> pinnedVertices(const Actor& actor);

// Gives the actor's hair these pins in place of those before. Throws InputError; then nothing has changed.
void applyPins(const std::vector<PinSpec>& pins, int actor, Demo& demo);

// After a drag that has moved vertices from where they were at rest: pins of the dragged ones go along with them.
void carryPins(std::span<const int> dragged, std::span<const Vec3> before, Actor& actor);

// The same pins for hair of another mesh: each will hold the vertex nearest to its own at rest.
std::vector<PinSpec> pinsForAnotherMesh(const Actor& actor);

}  // namespace app
