// Hair meshes that were modelled in another unit, with another axis up, about another origin or for another head.
#pragma once

#include <span>
#include <string>

#include "app/figure/character.h"
#include "sim/mesh/hair_mesh.h"

namespace app {

// m, median distance of the roots from the scalp up to which a hair mesh fits as it is; of a head of 23 cm, and in
// proportion.
inline constexpr double kFarRoots = 0.018;

// m, median over the roots. The shape is in the scalp's frame.
double rootDistance(const sim::HairMeshShape& shape, const Scalp& scalp);

// What is known of a shape.
struct ToldPlace {
  bool metres = false;
  bool axes = false;  // y up, facing z
  char up = 0;        // y or z; 0: unknown
};

// Where the roots are far from the scalp: finds the unit (m, cm, mm, inches, feet), the axes (y up; z up, facing -y as
// in Blender, or y), the origin (head joint or the figure's own) and at last the scale and place that bring them to it.
// Hair that hangs must hang down, hair that stands must rise from its roots, and these must be spread as over a head. A
// head of hair leaves the face free. With `mend` the shape is brought there. Returns what was found, and done, in
// words; empty when the roots fit as they are, and would not fit far better turned about. Of two that fit the simpler
// one is taken, as listed; what is only moved before what is scaled. `told`: what is known and not sought.
// `scalp_points` (the shape's units and axes) are all over the scalp that the hair was made on: brought to this one in
// place of the roots. `as_made_distance` is set to the roots' distance from the scalp, m, at best by unit, axes and
// origin alone; to infinity where no such reading can be hair.
std::string fitHair(const Character& character, bool mend, sim::HairMeshShape& shape, ToldPlace told = {},
                    std::span<const Vec3> scalp_points = {}, double* as_made_distance = nullptr);

}  // namespace app
