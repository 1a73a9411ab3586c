// Of a body whose vertices lie about a pixel apart: lit there, once each, for its triangles are smaller than what pixels
// are shaded in.
#include "shared.h"
#include "common/skinning.glsl"
#include "common/body_light.glsl"
layout(location = 0) out vec3 radiance;

void main() {
  vec3 world, normal;
  skin(world, normal);
  radiance = bodyRadiance(rest_position, world, normal, root_cover.x, cloth,
                          forward.w > 0.0 ? hairLightOnSurface(world) : 1.0);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
