// Brows, lashes and lips of the grown mannequin, painted where app/figure/mannequin_head.cpp shapes lids and lips.
// q: head units (chin 0, crown 1; z forward), mirrored about x = 0.

// 1 within `half_width` of zero, 0 beyond, over an edge of `soft`.
float band(float x, float half_width, float soft) {
  return 1.0 - smoothstep(half_width - soft, half_width + soft, abs(x));
}

float hairNoise(vec2 p) {
  vec2 cell = floor(p), f = fract(p);
  vec4 corner = fract(sin(vec4(0.0, 1.0, 57.0, 58.0) + dot(cell, vec2(1.0, 57.0))) * 43758.5453);
  f = f * f * (3.0 - 2.0 * f);
  return mix(mix(corner.x, corner.y, f.x), mix(corner.z, corner.w, f.x), f.y);
}

// Darkness of the brow's hairs: an arch that rises to its outer third and tapers there.
float brow(vec2 m, float pixel) {
  float along = (m.x - 0.056) / 0.160;  // 0 inner end .. 1 outer end
  float t = clamp(along, 0.0, 1.0);
  float line = 0.574 + 0.036 * t * (1.75 - t) - 0.026 * t * t * t * t;
  float half_width = mix(0.0125, 0.0035, smoothstep(0.15, 1.0, t));
  float inside = band(m.y - line, half_width, 0.004 + pixel) * smoothstep(-0.08, 0.10, along) *
                 (1.0 - smoothstep(0.88, 1.02, along));
  // Hairs lean outwards, more so towards the outer end.
  float lean = mix(0.5, 2.6, t);
  float hairs = hairNoise(vec2((m.x - (m.y - line) * lean) * 420.0, (m.y - line) * 60.0 + 3.0));
  return inside * mix(0.55 + 0.65 * hairs, 0.85, clamp(pixel * 300.0, 0.0, 1.0));
}

// Height of the closed lids' edge: lowest in the middle of the eye.
float lidEdge(float x) {
  float u = (x - 0.132) / 0.070;
  return 0.4930 - 0.0190 * (1.0 - u * u) + 0.004 * u;
}

float lashes(vec2 m, float pixel) {
  float u = (m.x - 0.132) / 0.070, edge = lidEdge(m.x);
  float within = 1.0 - smoothstep(0.92, 1.06, abs(u));
  float line = band(m.y - edge, 0.0030 + 0.0010 * u, 0.0016 + pixel) * within;
  // Lashes fan out below the edge, longer at the outer corner.
  float below = edge - m.y, length = 0.0135 + 0.006 * u;
  float fan = m.x - 0.9 * below * (u + 0.15);
  float strokes = mix(smoothstep(0.35, 0.75, hairNoise(vec2(fan * 380.0, 1.5))), 0.45, clamp(pixel * 300.0, 0.0, 1.0));
  float fringe = step(0.0, below) * (1.0 - smoothstep(0.3 * length, length, below)) * strokes * within;
  return max(line, 0.75 * fringe);
}

// The fold above the closed lids, over which the socket begins: deepest in its middle.
float lidFold(vec2 m, float pixel) {
  float u = (m.x - 0.134) / 0.078, across = max(1.0 - u * u, 0.0);
  return band(m.y - 0.5010 - 0.0400 * sqrt(across), 0.0012, 0.0052 + pixel) * smoothstep(0.0, 0.5, across);
}

// Share of the lips' colour: x the lips, y the seam between them. They run out to points at the corners.
vec2 lips(vec2 m, float pixel) {
  float x2 = m.x * m.x, across = clamp(1.0 - x2 / 0.0106, 0.0, 1.0);
  float seam = 0.2070 + 0.6 * x2;
  float bow = 0.006 * exp(-(m.x - 0.028) * (m.x - 0.028) / 0.0003);
  float upper = seam + 0.0280 * pow(across, 0.85) + bow * across;
  float lower = seam - 0.0405 * pow(across, 0.70);
  float soft = 0.003 + pixel;
  float lip = smoothstep(lower - soft, lower + soft, m.y) * (1.0 - smoothstep(upper - soft, upper + soft, m.y)) *
              smoothstep(0.0, 0.12, across);
  return vec2(lip, band(m.y - seam + 0.0030, 0.0040, 0.0035 + pixel) * (1.0 - smoothstep(0.092, 0.106, m.x)));
}

// The share of the albedo that paint leaves, and in w what is left of the roughness. `brow_color`: of the brows' hairs.
// pixel: head units that a pixel spans.
vec4 facePaint(vec3 q, vec3 brow_color, float pixel) {
  if (q.z < 0.16 || q.y < 0.10 || q.y > 0.68 || abs(q.x) > 0.28) return vec4(1.0);
  vec2 m = vec2(abs(q.x), q.y);
  vec2 lip = lips(m, pixel);
  // Skin shines less where it folds: beside the lips, on the lids and about the nose.
  vec2 mouth = (m - vec2(0.0, 0.243)) / vec2(0.100, 0.026), fold = (m - vec2(0.132, 0.505)) / vec2(0.085, 0.045),
       wing = (m - vec2(0.062, 0.335)) / vec2(0.030, 0.030);
  float folds = max(exp(-dot(mouth, mouth)), max(exp(-dot(fold, fold)), exp(-dot(wing, wing))));
  vec4 paint = mix(vec4(vec3(1.0), 1.0 + 0.5 * folds), vec4(0.84, 0.56, 0.53, 0.68), lip.x);
  paint *= 1.0 - lip.y * vec4(vec3(0.6), -0.6);
  vec2 lid = (m - vec2(0.132, 0.517)) / vec2(0.070, 0.026);
  paint.rgb *= mix(vec3(1.0), vec3(0.86, 0.79, 0.77), exp(-dot(lid, lid)));
  paint.rgb *= 1.0 - 0.30 * lidFold(m, pixel) * vec3(0.8, 1.0, 1.0);
  vec2 nostril = (m - vec2(0.0290, 0.3180)) / vec2(0.0130, 0.0060);
  paint.rgb *= 1.0 - 0.75 * (1.0 - smoothstep(0.6, 1.3, length(nostril))) * smoothstep(0.37, 0.39, q.z);
  paint.rgb = mix(paint.rgb, brow_color, 0.88 * brow(m, pixel));
  paint = mix(paint, vec4(0.09, 0.075, 0.07, 1.6), lashes(m, pixel));
  return paint;
}
