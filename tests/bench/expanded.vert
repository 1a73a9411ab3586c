// A strand's ribbon whose corners are there already: as strand.geom wrote them.
layout(location = 0) in vec4 corner;
layout(location = 1) in vec4 shade;
layout(location = 2) in float number;
layout(location = 0) out vec4 lit;
layout(location = 1) flat out float dither;

void main() {
  lit = shade;
  dither = number;
  gl_Position = corner;
}
