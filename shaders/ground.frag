#include "shared.h"
#include "common/shadow.glsl"
#include "common/backdrop.glsl"
layout(location = 0) in vec3 world;
layout(location = 0) out vec4 color;

void main() {
  float out_there = length(world.xz - ground_center.xz) / ground_center.w;
  float shown = 1.0 - smoothstep(0.0, 0.9, out_there);
  float lit = 1.0;
  if (forward.w > 0.0) lit = bodyLightOnSurface(world, vec3(0.0, 1.0, 0.0), kGroundTaps) * hairLightOnSurface(world);
  vec3 light = lit * key.rgb * max(to_key.y, 0.0) + fill.rgb * max(to_fill.y, 0.0) + rim.rgb * max(to_rim.y, 0.0) * 0.5;
  vec3 radiance = ground_color.rgb * (light / 3.14159265 + sky.rgb);
  color = vec4(mix(backdropColor(gl_FragCoord.xy * viewport.zw), radiance, shown), 1.0);
}
