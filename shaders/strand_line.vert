// Lines in the light's view of strands that strand_lines.comp has grown: an instance is a strand, a vertex a point.
#include "shared.h"

layout(std430, binding = kSlotStrands) readonly restrict buffer Strands { uint strands[]; };
layout(std430, binding = kSlotPoints) readonly restrict buffer Points { vec4 points[]; };
layout(location = 0) flat out float strand_opacity;

void main() {
  int shown = int(strands[gl_InstanceID]);
  strand_opacity = 0.0;
  if (shown < 2) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // all of the strand outside the view
    return;
  }
  vec4 point = points[gl_InstanceID * draw.z + min(gl_VertexID, shown - 1)];
  strand_opacity = point.w;
  gl_Position = vec4(2.0 * point.xy / hair_shadow_size[draw.w].y - 1.0, 2.0 * point.z - 1.0, 1.0);
}
