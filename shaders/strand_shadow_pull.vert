// The pulling path of the light's view: an instance is a strand, a vertex a point of its line.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/ribbon.glsl"
#include "common/opacity_line.glsl"

layout(location = 0) flat out float strand_opacity;

void main() {
  Strand strand = makeStrand(gl_InstanceID);
  if (strand.gain <= 0.0) {
    strand_opacity = 0.0;
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // all of the strand outside the view
    return;
  }
  float s = pointParameter(strand, min(gl_VertexID, lastPoint(strand)));
  int layer = layerOf(strand, s);
  CurvePoint point = curvePoint(strand, layerWindow(strand, layer), s, s - float(layer));
  strand_opacity = lineOpacity(strand, point);
  gl_Position = hair_shadow[draw.w] * vec4(point.position, 1.0);
}
