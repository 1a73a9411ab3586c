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

// Each tie about the middle of what it holds and as wide as a disc that is filled as evenly; one that holds nothing as
// it is. `places`: as above.
std::vector<HairTie> fittedRings(std::span<const HairTie> ties, const Scalp& scalp, std::span<const Vec3> places);

}  // namespace app
