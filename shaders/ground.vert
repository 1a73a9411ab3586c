// A square of ground around the scene; the fragment stage rounds and fades it.
#include "shared.h"
layout(location = 0) out vec3 world;
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  world =
      vec3(ground_center.x + corner.x * ground_center.w, ground_color.w, ground_center.z + corner.y * ground_center.w);
  gl_Position = view_projection * vec4(world, 1.0);
}
