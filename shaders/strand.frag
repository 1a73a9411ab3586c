// A strand thinner than the ribbon drawn for it takes only its share of a pixel's samples: how many is rounded by a
// number of the strand's own, which does not change from frame to frame, so thin hair fades without shimmer.
#include "shared.h"
layout(location = 0) in vec4 lit;
layout(location = 1) flat in float dither;
layout(location = 0) out vec4 color;

void main() {
  int samples = int(sky.w + 0.5);  // not gl_NumSamples, which SPIR-V lacks
  int taken = int(clamp(lit.a, 0.0, 1.0) * float(samples) + dither);
  int turn = int(fract(dither * 61.803) * float(samples));
  int mask = (1 << taken) - 1;
  gl_SampleMask[0] = ((mask << turn) | (mask >> (samples - turn))) & ((1 << samples) - 1);
  color = vec4(lit.rgb, 1.0);
}
