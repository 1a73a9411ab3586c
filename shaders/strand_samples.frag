// Brings the strands' samples into the radiance: each was rasterized on the CPU and knows the segment that it shows.
#include "shared.h"
layout(std430, binding = kSlotSamples) readonly restrict buffer Samples { uint samples[]; };
layout(std430, binding = kSlotColors) readonly restrict buffer Colors { vec4 colors[]; };
layout(location = 0) out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int at = (pixel.y * int(viewport.x) + pixel.x) * 8 + gl_SampleID;
  gl_FragDepth = uintBitsToFloat(samples[at]);
  uint shown = samples[at + 4];
  int first = int(shown >> 8u);
  color = vec4(mix(colors[first].rgb, colors[first + 1].rgb, float(shown & 255u) / 255.0), 1.0);
}
