#include "shared.h"
#include "common/body_light.glsl"
#include "common/materials.glsl"
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 2) in float cover;
layout(location = 3) in vec3 rest;
layout(location = 4) in float garment;
#ifdef HAIR_LIGHT_AT_VERTICES
layout(location = 5) in vec4 through_hair;
#endif
#ifdef OWN_MATERIALS
layout(location = 6) in vec3 place;
#else
const vec3 place = vec3(0.0);
#endif
layout(location = 0) out vec4 color;

void main() {
#ifndef HAIR_LIGHT_AT_VERTICES
  vec4 through_hair = lightUnderHair(world, normalize(normal));
#endif
  color = vec4(bodyRadiance(materialColor(place), rest, world, normal, cover, garment, through_hair), 1.0);
}
