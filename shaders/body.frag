#include "shared.h"
#include "common/body_light.glsl"
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 normal;
layout(location = 2) in float cover;
layout(location = 3) in vec3 rest;
layout(location = 4) in float garment;
layout(location = 0) out vec4 color;

void main() {
  color = vec4(bodyRadiance(rest, world, normal, cover, garment), 1.0);
}
