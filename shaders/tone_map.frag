// Resolves the samples and brings radiance to the screen. Samples are weighed by 1 / (1 + luminance) so that one bright
// glint does not drown the other samples of its pixel and edges stay smooth (Karis 2013).
#include "shared.h"
#include "common/film.glsl"
#include "common/hash.glsl"
layout(binding = kUnitColor) uniform sampler2DMS samples;
layout(location = 0) uniform int sample_count;
layout(location = 1) uniform float exposure;
layout(location = 0) out vec4 color;

void main() {
  vec4 sum = vec4(0.0);
  for (int i = 0; i < sample_count; ++i) {
    vec3 radiance = exposure * texelFetch(samples, ivec2(gl_FragCoord.xy), i).rgb;
    float weight = 1.0 / (1.0 + dot(radiance, vec3(0.2126, 0.7152, 0.0722)));
    sum += weight * vec4(radiance, 1.0);
  }
  // Half a step of fixed noise hides the steps of 8 bits in smooth gradients.
  uint key = hash(uint(gl_FragCoord.x), uint(gl_FragCoord.y));
  float grain = (unitFloat(key) - 0.5) / 255.0;
  color = vec4(encodeSrgb(film(sum.rgb / sum.a)) + grain, 1.0);
}
