// Shades the stored points that some sample of the picture shows, or ALL_POINTS: an invocation is a point.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/shadow.glsl"
#include "common/hair_shading.glsl"

layout(local_size_x = kStrandGroup) in;
#include "common/invocation.glsl"
layout(std430, binding = kSlotStrands) readonly restrict buffer Strands { uvec4 strands[]; };
layout(std430, binding = kSlotPoints) readonly restrict buffer Points { vec4 points[]; };
#ifndef ALL_POINTS
layout(std430, binding = kSlotSeen) readonly restrict buffer Seen { int seen[]; };
#endif
layout(std430, binding = kSlotColors) writeonly restrict buffer Colors { vec4 colors[]; };
layout(location = 0) uniform int count;
layout(location = 1) uniform int first_color;  // of the hair

void main() {
  int listed = invocation();
  if (listed >= count) return;
#ifdef ALL_POINTS
  int at = listed;
#else
  int at = seen[listed];
#endif
  uvec4 of = strands[2 * (at / draw.z)];
  if (at % draw.z >= int(of.x)) return;
  vec4 share = uintBitsToFloat(strands[2 * (at / draw.z) + 1]);
  Strand strand;
  strand.key = of.z;
  strand.clump_key = of.w;
  strand.share = StrandShare(vec4(1.0, 1.0, 1.0, share.w), share.rgb, 1.0);
  vec4 place = points[kPointTexels * at], along = points[kPointTexels * at + 1], depths = points[kPointTexels * at + 2];
  CurvePoint point = CurvePoint(place.xyz, along.xyz, vec3(along.w, depths.xy), depths.zw, place.w);
  colors[first_color + at] = vec4(shadeStrand(strand, point), 0.0);
}
