// Of a body whose vertices lie about a pixel apart: lit there, once each, for its triangles are smaller than what pixels
// are shaded in.
#include "shared.h"
#include "common/skinning.glsl"
#include "common/body_light.glsl"
#include "common/materials.glsl"
layout(location = 0) out vec3 radiance;

const float kSmallLevel = 4.0;  // a vertex stands for many texels

void main() {
  vec3 world, normal;
  skin(world, normal);
  vec3 base = materialColorAt(material_place, kSmallLevel);
  radiance = bodyRadiance(base, rest_position, world, normal, root_cover.x, cloth,
                          lightUnderHair(world, normalize(normal)));
  gl_Position = clip_from_world * vec4(world, 1.0);
}
