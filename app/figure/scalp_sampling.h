// The scalp that hair grows on, sampled from a head's mesh.
#pragma once

#include <span>

#include "app/figure/character.h"

namespace app {

// Where a head's landmarks are, in the scalp frame (m).
struct HeadMeasure {
  double chin = -0.07, crown = 0.16;  // y
  Vec3 center = Vec3::Zero();         // middle of the cranium, level with the top of the ears
};

// Landmarks of any head from its vertices (scalp frame): crown, lowest point of the front, cranium's middle.
HeadMeasure measureHead(std::span<const Vec3> vertices);

// Radial distances of the mesh's outermost surface over the grid of Scalp (65 x 128). Ears and other narrow bumps
// at the head's sides are cut off; directions that meet no triangle (the neck's opening) are filled in smoothly.
Scalp sampleScalp(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles,
                       const HeadMeasure& measure);

}  // namespace app
