// Adds a strand's opacity to the deep opacity layer that it lies in; what lies behind all layers goes into one more. In
// whole steps: their sum is the same in any order.
#include "shared.h"
#include "common/opacity_sums.glsl"
layout(binding = kUnitHairDepth) uniform sampler2DArray hair_depth;
layout(location = 0) flat in float strand_opacity;

void main() {
  ivec3 origin = tileOrigin(textureSize(hair_depth, 0).xy);
  float first = texelFetch(hair_depth, ivec3(ivec2(gl_FragCoord.xy), origin.z), 0).r;
  float behind = max((gl_FragCoord.z - first) * hair_shadow_size[draw.w].z, 0.0) / hair_shadow_size[draw.w].w;
  int layer = min(int(log2(1.0 + (kLayerGrowth - 1.0) * behind) / log2(kLayerGrowth)), kMaxOpacityLayers);
  imageAtomicAdd(opacity_sums, ivec3(ivec2(gl_FragCoord.xy) - origin.xy, layer),
                 uint(min(strand_opacity, kMaxLineOpacity) * kOpacitySteps + 0.5));
}
