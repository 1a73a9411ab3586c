#include "shared.h"
#include "common/skinning.glsl"
layout(location = 0) out vec3 world;
layout(location = 1) out vec3 normal;
layout(location = 2) out float cover;
layout(location = 3) out vec3 rest;
layout(location = 4) out float garment;
#ifdef OWN_MATERIALS
layout(location = 6) out vec3 place;
#endif
#ifdef HAIR_LIGHT_AT_VERTICES
#include "common/under_hair.glsl"
layout(location = 5) out vec4 through_hair;
#endif

void main() {
  skin(world, normal);
  cover = root_cover.x;
  rest = rest_position;
  garment = cloth;
#ifdef OWN_MATERIALS
  place = material_place;
#endif
#ifdef HAIR_LIGHT_AT_VERTICES
  through_hair = lightUnderHair(world, normalize(normal));
#endif
  gl_Position = clip_from_world * vec4(world, 1.0);
}
