// Where a tie holds what it has gathered.
#pragma once

#include <span>
#include <vector>

#include "app/styles/style_tie.h"

namespace app {

// For each vertex in a ring (TiedHair::rings, those of all ties in one list) its place within the nearest tie's radius:
// m, scalp frame. The hair at rest is wider than that where its prisms need the room.
std::vector<Vec3> ringPlaces(const sim::HairMeshShape& tied, const Scalp& scalp, std::span<const HairTie> ties,
                             std::span<const int> ring);

// The tie as narrow as the hair that it holds, and about its middle. `places`: those of its ring; none: the tie as it
// is.
HairTie fittedRing(const HairTie& tie, const Scalp& scalp, std::span<const Vec3> places);

}  // namespace app
