// Grows one chunk of one strand as a line in the light's view. Lines are a texel wide; what a hair covers of it goes
// along.
#include "shared.h"
#include "common/hash.glsl"
#include "common/strand.glsl"
#include "common/ribbon.glsl"
#include "common/opacity_line.glsl"

layout(points) in;
layout(line_strip, max_vertices = kChunkPoints) out;
layout(location = 0) flat out float strand_opacity;
#ifdef CAPTURE_POINTS
out vec4 captured;  // position, number of the strand: for tests, by transform feedback
#endif

void main() {
  int number = gl_PrimitiveIDIn / draw.y, start = (gl_PrimitiveIDIn % draw.y) * (kChunkPoints - 1);
  Strand strand = makeStrand(number);
  int last = lastPoint(strand);
  if (start >= last || strand.gain <= 0.0) return;
  int first = skin_count.x > 0 ? 0 : start, layer = layerOf(strand, pointParameter(strand, first));
  LayerWindow window = layerWindow(strand, layer);
  SkinLift lift = noLift();
  for (int index = first; index <= min(start + kChunkPoints - 1, last); ++index) {
    float s = pointParameter(strand, index);
    moveWindow(strand, layerOf(strand, s), layer, window);
    CurvePoint point = curvePoint(strand, window, s, s - float(layer), lift);
    if (index < start) continue;
    strand_opacity = lineOpacity(strand, point);
    gl_Position = hair_shadow[draw.w] * vec4(point.position, 1.0);
#ifdef CAPTURE_POINTS
    captured = vec4(point.position, float(number));
#endif
    EmitVertex();
  }
  EndPrimitive();
}
