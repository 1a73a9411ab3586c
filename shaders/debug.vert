// Debug lines, triangles and points: colours arrive as they should look on the screen, so the film curve is undone for
// them.
#include "shared.h"
#include "common/film.glsl"
layout(location = 0) in vec3 world;
layout(location = 1) in vec4 rgba;
layout(location = 0) uniform float visibility;
layout(location = 1) uniform float exposure;
layout(location = 0) out vec4 shown;

void main() {
  shown = vec4(filmInverse(decodeSrgb(rgba.rgb)) / max(exposure, 1e-4), rgba.a * visibility);
  gl_Position = view_projection * vec4(world, 1.0);
  gl_PointSize = 7.0;
}
