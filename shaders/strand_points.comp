// Grows strands of a hair once: an invocation is a strand. KEEP_ASIDE: for strand_grown.vert; without it projected, for
// strand_raster.h.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/ribbon.glsl"

layout(local_size_x = kStrandGroup) in;
#include "common/invocation.glsl"
layout(std430, binding = kSlotRibbons) writeonly restrict buffer Ribbons { vec4 ribbons[]; };
layout(std430, binding = kSlotStrands) writeonly restrict buffer Strands { uvec4 strands[]; };
layout(std430, binding = kSlotPoints) writeonly restrict buffer Points { vec4 points[]; };

layout(location = 0) uniform int first_strand;

#ifdef KEEP_ASIDE
void storeRibbon(int at, in CurvePoint point, in RibbonPoint ribbon) {
  ribbons[at] = vec4(ribbon.aside, ribbon.coverage);
}
#else
vec2 toPixels(vec4 clip) { return (0.5 + 0.5 * clip.xy / clip.w) * viewport.xy; }

void storeRibbon(int at, in CurvePoint point, in RibbonPoint ribbon) {
  vec4 clip = view_projection * vec4(point.position, 1.0);
  bool before = clip.z < -clip.w || clip.w <= 0.0;  // of the near plane
  vec2 left = toPixels(view_projection * vec4(point.position - ribbon.aside, 1.0));
  vec2 right = toPixels(view_projection * vec4(point.position + ribbon.aside, 1.0));
  ribbons[2 * at] = vec4(left, right);
  ribbons[2 * at + 1] = vec4(before ? -1.0 : 0.5 + 0.5 * clip.z / clip.w, ribbon.coverage, 0.0, 0.0);
}
#endif

void main() {
  int slot = invocation(), number = first_strand + slot;
  if (number >= draw.x) return;
  Strand strand = makeStrand(number);
  float dither = strandDither(strand);
  int last = lastShownPoint(strand, dither), first = slot * draw.z;
  strands[2 * slot] = uvec4(uint(last < 1 ? 0 : last + 1), floatBitsToUint(dither), strand.key, strand.clump_key);
  strands[2 * slot + 1] = floatBitsToUint(vec4(strand.share.color, strand.share.of.w));
  if (last < 1) return;
  int layer = 0;
  LayerWindow window = layerWindow(strand, layer);
  SkinLift lift = noLift();
  for (int index = 0; index <= last; ++index) {
    float s = pointParameter(strand, index);
    moveWindow(strand, layerOf(strand, s), layer, window);
    CurvePoint point = curvePoint(strand, window, s, s - float(layer), lift);
    storeRibbon(first + index, point, ribbonPoint(strand, point));
    int at = kPointTexels * (first + index);
    points[at] = vec4(point.position, point.along);
    points[at + 1] = vec4(point.tangent, point.light.x);
    points[at + 2] = vec4(point.light.yz, point.behind);
  }
}
