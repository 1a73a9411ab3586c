// Grows the strands that cast a hair's shadow, in the texels of its map, for line_raster.h and strand_line.vert: an
// invocation is a strand.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/ribbon.glsl"
#include "common/opacity_line.glsl"

layout(local_size_x = kStrandGroup) in;
#include "common/invocation.glsl"
layout(std430, binding = kSlotStrands) writeonly restrict buffer Strands { uint strands[]; };  // points of a strand
layout(std430, binding = kSlotPoints) writeonly restrict buffer Points { vec4 points[]; };  // texels, depth, opacity
layout(location = 0) uniform int first_strand;

void main() {
  int slot = invocation(), number = first_strand + slot;
  if (number >= draw.x) return;
  Strand strand = makeStrand(number);
  int last = lastPoint(strand), first = slot * draw.z;
  bool shades = last > 0 && strand.gain > 0.0;
  strands[slot] = shades ? uint(last + 1) : 0u;
  if (!shades) return;
  float side = hair_shadow_size[draw.w].y;
  int layer = 0;
  LayerWindow window = layerWindow(strand, layer);
  SkinLift lift = noLift();
  for (int index = 0; index <= last; ++index) {
    float s = pointParameter(strand, index);
    moveWindow(strand, layerOf(strand, s), layer, window);
    CurvePoint point = curvePoint(strand, window, s, s - float(layer), lift);
    vec4 clip = hair_shadow[draw.w] * vec4(point.position, 1.0);
    points[first + index] = vec4((0.5 + 0.5 * clip.xy) * side, 0.5 + 0.5 * clip.z, lineOpacity(strand, point));
  }
}
