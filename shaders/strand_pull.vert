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
  Strand strand = makeStrand(gl_InstanceID);
  dither = strandDither(strand);
  lit = vec4(0.0);
  int last = lastShownPoint(strand, dither), index = min(gl_VertexID >> 1, last);
  if (last < 1) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // all of the strand outside the view
    return;
  }
  float s = pointParameter(strand, index);
  int layer = layerOf(strand, s);
  CurvePoint point = curvePoint(strand, layerWindow(strand, layer), s, s - float(layer));
  RibbonPoint ribbon = ribbonPoint(strand, point);
  lit = vec4(shadeStrand(strand, point), ribbon.coverage);
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  gl_Position = view_projection * vec4(point.position + side * ribbon.aside, 1.0);
}
