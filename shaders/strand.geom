// Grows one chunk of one strand as a camera-facing ribbon, shaded per point.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/shadow.glsl"
#include "common/hair_shading.glsl"
#include "common/ribbon.glsl"

layout(points) in;
layout(triangle_strip, max_vertices = 2 * kChunkPoints) out;
layout(location = 0) out vec4 lit;  // radiance, coverage
layout(location = 1) flat out float dither;

void main() {
  int number = gl_PrimitiveIDIn / draw.y, start = (gl_PrimitiveIDIn % draw.y) * (kChunkPoints - 1);
  Strand strand = makeStrand(number);
  float own_dither = strandDither(strand);
  int last = lastShownPoint(strand, own_dither);
  if (start >= last) return;
  int first = skin_count.x > 0 ? 0 : start, layer = layerOf(strand, pointParameter(strand, first));
  LayerWindow window = layerWindow(strand, layer);
  SkinLift lift = noLift();
  for (int index = first; index <= min(start + kChunkPoints - 1, last); ++index) {
    float s = pointParameter(strand, index);
    moveWindow(strand, layerOf(strand, s), layer, window);
    CurvePoint point = curvePoint(strand, window, s, s - float(layer), lift);
    if (index < start) continue;
    RibbonPoint ribbon = ribbonPoint(strand, point);
    vec4 color = vec4(shadeStrand(strand, point), ribbon.coverage);
    for (int side = -1; side <= 1; side += 2) {
      lit = color;
      dither = own_dither;
      gl_Position = view_projection * vec4(point.position + float(side) * ribbon.aside, 1.0);
      EmitVertex();
    }
  }
  EndPrimitive();
}
