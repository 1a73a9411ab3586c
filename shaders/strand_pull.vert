// The pulling path: an instance is a strand, two vertices a ribbon point. Draws what strand.geom draws.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/shadow.glsl"
#include "common/hair_shading.glsl"
#include "common/ribbon.glsl"

layout(location = 0) out vec4 lit;
layout(location = 1) flat out float dither;

void main() {
  Strand strand = makeStrand(gl_InstanceID * draw.x);
  float s = pointParameter(strand, min(gl_VertexID >> 1, lastPoint(strand)));
  int layer = layerOf(strand, s);
  CurvePoint point = curvePoint(strand, layerWindow(strand, layer), s, s - float(layer));
  RibbonPoint ribbon = ribbonPoint(point);
  lit = vec4(shadeStrand(strand, point), ribbon.coverage);
  dither = randomOf(strand.key, 30u);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  gl_Position = view_projection * vec4(point.position + side * ribbon.aside, 1.0);
}
