// Hair ties: a haircut combed over the scalp through rings, and hanging from them as tails.
#pragma once

#include <span>
#include <vector>

#include "app/styles/hair_styles.h"

namespace app {

// A ring that stands off the scalp. `at` and directions are in the scalp's frame.
struct HairTie {
  Vec3 at = Vec3::Zero();  // m, the ring's middle; its axis leads away from the head's middle
  double radius = 0.02;    // m
  int side = 0;            // -1, 1: takes the hair of that side of the head alone (sign of x); 0: all
  double above = -1e3;     // m over the head's middle: takes what is rooted higher alone
  bool bun = false;        // what is left beyond the ring is wound about it, where it is long enough
};

// `shape` has groom offsets: up to the ring strands lie where the hair was combed, closer to the head than prisms can be
// thin.
struct TiedHair {
  sim::HairMeshShape shape;
  std::vector<std::vector<int>> rings;  // per tie: the vertices in it, one a column
  std::vector<double> left;             // per tie: m of hair beyond the ring, in the mean
  std::vector<bool> wound;              // per tie: whether that is in a bun, for which a short stub stands in
  int loose = 0;                        // bundles of the ties' sides whose way to the ring would cross the face
};

// Whether the bundles of a tail that were divided over the shoulders are joined. Under a hat they are not: on their own
// they find more room.
enum class Seams { kClosed, kOpen };

// m, for a ring of this radius: of the rope that hair is twisted to for a bun, and the shortest such rope.
constexpr double ropeRadius(double radius) {
  return radius / 2;
}
double shortestBun(double radius);

// Combs every bundle to the first tie that takes it: over the scalp, those rooted farther above those rooted nearer,
// through the ring, and on as a tail as long as the hair has left in the mean. Bundles that no tie takes stay. Where
// two ties part the hair, columns between them are doubled, and where hair that one tie takes divides over
// the shoulders they are joined. Every prism is positive on the heads of the tests; the
// caller's buildHairMesh says where one is not. Deterministic.
TiedHair tieHair(const sim::HairMeshShape& hair, const Scalp& scalp, const BodyDistance& body,
                 std::span<const HairTie> ties, Seams seams = Seams::kClosed);

// By how much (m) the hair that lacks most ends before the ring that takes it; 0: all of it reaches.
double shortOfRing(const sim::HairMeshShape& hair, const Scalp& scalp, std::span<const HairTie> ties);

}  // namespace app
