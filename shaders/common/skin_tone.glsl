// Skin is of no one colour: blood shows in blotches and at ears, nose and cheeks, and its relief breaks the highlight.
#include "common/hash.glsl"

float toneAt(ivec3 cell) { return unitFloat(hash(uint(cell.x), hash(uint(cell.y), uint(cell.z)))); }

// 0..1, smooth over cells of one unit.
float toneNoise(vec3 p) {
  ivec3 cell = ivec3(floor(p));
  vec3 f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  vec4 low, high;  // at the cell's corners, by x and y
  for (int k = 0; k < 4; ++k) {
    ivec3 corner = cell + ivec3(k & 1, k >> 1, 0);
    low[k] = toneAt(corner);
    high[k] = toneAt(corner + ivec3(0, 0, 1));
  }
  vec4 flat_z = mix(low, high, f.z);
  vec2 flat_y = mix(flat_z.xy, flat_z.zw, f.y);
  return mix(flat_y.x, flat_y.y, f.x);
}

// 1 at `middle`, 0 well beyond `size`.
float spot(vec3 m, vec3 middle, vec3 size) {
  vec3 off = (m - middle) / size;
  return exp(-dot(off, off));
}

const vec3 kBlood = vec3(1.03, 0.84, 0.81);  // share of the albedo that a full flush leaves

// The share of the albedo that tone leaves, and in w of the roughness. rest: rest pose, m. q: head units, see face.glsl.
// pixel: m that a pixel spans; what is finer than that is left out.
vec4 skinTone(vec3 rest, vec3 q, float pixel) {
  vec3 m = vec3(abs(q.x), q.yz);
  // Blotches of 2 cm.
  float flush = (0.40 * toneNoise(rest * 60.0) - 0.20) * (1.0 - smoothstep(0.004, 0.012, pixel));
  flush += 0.55 * spot(m, vec3(0.0, 0.352, 0.430), vec3(0.075, 0.055, 0.070));   // nose
  flush += 0.60 * spot(m, vec3(0.190, 0.390, 0.270), vec3(0.090, 0.075, 0.150));  // cheeks
  flush += 0.80 * spot(m, vec3(0.330, 0.470, -0.040), vec3(0.040, 0.150, 0.110));  // ears
  flush += 0.25 * spot(m, vec3(0.0, 0.085, 0.340), vec3(0.080, 0.060, 0.080));   // chin
  vec4 tone = vec4(mix(vec3(1.0), kBlood, flush), 1.0);
  float relief = (toneNoise(rest * 1100.0) - 0.5) * (1.0 - smoothstep(0.0003, 0.0009, pixel));
  return tone * (1.0 + relief * vec4(vec3(0.07), 0.12));
}
