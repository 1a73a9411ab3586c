#include "shared.h"
#include "common/backdrop.glsl"
layout(location = 0) in vec2 at;
layout(location = 0) out vec4 color;
void main() { color = vec4(backdropColor(at), 1.0); }
