// Adds a strand's opacity to every deep opacity layer that reaches behind it; the eighth channel takes all.
#include "shared.h"
layout(binding = kUnitHairDepth) uniform sampler2DArray hair_depth;
layout(location = 0) flat in float strand_opacity;
layout(location = 0) out vec4 near;
layout(location = 1) out vec4 far;

void main() {
  float first = texelFetch(hair_depth, ivec3(ivec2(gl_FragCoord.xy), int(hair_shadow_tile[draw.w].w)), 0).r;
  float behind = (gl_FragCoord.z - first) * hair_shadow_size[draw.w].z;
  float held[8], reach = 0.0, thickness = hair_shadow_size[draw.w].w;
  for (int layer = 0; layer < kMaxOpacityLayers; ++layer) {
    reach += thickness;
    thickness *= kLayerGrowth;
    held[layer] = behind < reach ? strand_opacity : 0.0;
  }
  near = vec4(held[0], held[1], held[2], held[3]);
  far = vec4(held[4], held[5], held[6], strand_opacity);
}
