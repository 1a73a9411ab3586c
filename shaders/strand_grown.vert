// Ribbons of strands that strand_points.comp has grown and strand_shade.comp lit: an instance is a strand, two vertices
// a point. Draws what strand.geom draws.
#include "shared.h"

layout(std430, binding = kSlotRibbons) readonly restrict buffer Ribbons { vec4 ribbons[]; };
layout(std430, binding = kSlotStrands) readonly restrict buffer Strands { uvec4 strands[]; };
layout(std430, binding = kSlotPoints) readonly restrict buffer Points { vec4 points[]; };
layout(std430, binding = kSlotColors) readonly restrict buffer Colors { vec4 colors[]; };
layout(location = 0) out vec4 lit;
layout(location = 1) flat out float dither;

void main() {
  uvec4 strand = strands[2 * gl_InstanceID];
  int shown = int(strand.x), at = gl_InstanceID * draw.z + min(gl_VertexID >> 1, shown - 1);
  dither = uintBitsToFloat(strand.y);
  lit = vec4(0.0);
  if (shown < 2) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // all of the strand outside the view
    return;
  }
  vec4 ribbon = ribbons[at];
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  lit = vec4(colors[at].rgb, ribbon.w);
  gl_Position = view_projection * vec4(points[kPointTexels * at].xyz + side * ribbon.xyz, 1.0);
}
