// Light that the hair over a body lets through to its surface.
#include "common/shadow.glsl"

layout(binding = kUnitOpenness) uniform sampler3D openness;  // T(w) = a + b . w, see render/light/sky_visibility.h
layout(location = 1) uniform mat4 openness_from_world;

// The lattice smears hair over a cell about it: it is read so far over the skin (m). And it knows no gaps between
// locks: so much comes through them.
const float kOverSkin = 0.015, kThroughGaps = 0.15;

// Shares of the key light, of the sky (over the half space of the normal), of the fill and of the rim light.
vec4 lightUnderHair(vec3 world, vec3 normal) {
  vec4 texel = textureLod(openness, (openness_from_world * vec4(world + kOverSkin * normal, 1.0)).xyz, 0.0);
  vec3 slope = (255.0 * texel.yzw - 128.0) / 127.0;
  vec3 along = vec3(2.0 / 3.0 * dot(slope, normal), dot(slope, to_fill.xyz), dot(slope, to_rim.xyz));
  vec3 open = mix(vec3(kThroughGaps), vec3(1.0), clamp(texel.x + along, 0.0, 1.0));
  return vec4(forward.w > 0.0 ? hairLightOnSurface(world) : 1.0, open);
}
