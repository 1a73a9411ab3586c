// Deep opacity layers of a hair's tile out of what opacity.frag has added up: each holds what lies before its end.
#include "shared.h"
#include "common/opacity_sums.glsl"

layout(local_size_x = kTileGroup, local_size_y = kTileGroup) in;
layout(binding = kImageNear, rgba16f) writeonly restrict uniform image2DArray opacity_near;
layout(binding = kImageFar, rgba16f) writeonly restrict uniform image2DArray opacity_far;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(hair_shadow_size[draw.w].y)))) return;
  uint held = 0u;
  float layers[kOpacitySums];
  for (int layer = 0; layer < kOpacitySums; ++layer) {
    held += imageLoad(opacity_sums, ivec3(texel, layer)).x;
    layers[layer] = float(held) / kOpacitySteps;
  }
  ivec3 at = tileOrigin(imageSize(opacity_near).xy) + ivec3(texel, 0);
  imageStore(opacity_near, at, vec4(layers[0], layers[1], layers[2], layers[3]));
  imageStore(opacity_far, at, vec4(layers[4], layers[5], layers[6], layers[7]));
}
