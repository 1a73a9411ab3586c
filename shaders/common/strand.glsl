// The strand curve: grown from (root face, position in the face) out of the hair mesh's vertices, nothing stored per
// strand.
//
// Across a face every layer is one smooth patch: a bicubic Coons patch over a quadrilateral, a cubic Bezier triangle
// over a triangle, both bounded by the same cubic Hermite edge curves, whose end tangents are G d: G the vertex's
// in-layer gradient (two 3-vectors), d the edge in the rest scalp's tangent plane. A point of any layer is therefore
// one fixed linear combination of the corners' positions and gradients: the weights are made once a strand. Along the
// strand: uniform Catmull-Rom through the layers (C1). Sources: Yuksel et al. 2009 (hair meshes); Farin, Curves and
// Surfaces for CAGD (Coons patches, cubic triangles); Vlachos et al. 2001 (the centre point of the triangle); Roberts
// 2018 (R2 sequence).
//
// render/strands/strand_growth.cpp grows the same strands on the CPU, function by function: a change here is one there,
// and tests/render/strand_growth_test.cpp compares the two.

layout(binding = kUnitVertices) uniform samplerBuffer vertex_texels;
layout(binding = kUnitLayout) uniform samplerBuffer layout_texels;
layout(binding = kUnitTable) uniform samplerBuffer table_texels;  // which strands of which faces are drawn

const float kPi = 3.14159265358979;

struct Strand {
  ivec4 first;  // first vertex of each corner's column; [3] repeats [2] with weight 0 in a triangle
  int layers;
  vec4 weight;   // of positions
  vec4 along_u;  // of gradients du
  vec4 along_v;  // of gradients dv
  vec4 pull_u;   // what the clump adds to along_u, along_v at full strength
  vec4 pull_v;
  vec4 blend;      // linear weights: frames and light
  float end;       // curve parameter of the tip, in layers
  uint key;        // hash key of the strand
  uint clump_key;  // hash key of its clump
  float loose;     // 1 for a flyaway, else 0
  float segments;  // a layer
  float gain;      // of width and opacity: how many strands this one stands for
};

struct LayerPoint {
  vec3 position;
  vec3 axis_u, axis_v;
  vec3 light;   // sky visibility, optical depth towards fill, towards rim
  vec2 behind;  // optical depth away from fill, from rim
};

struct CurvePoint {
  vec3 position;
  vec3 tangent;  // unit
  vec3 light;
  vec2 behind;
  float along;  // 0 root .. 1 tip of this strand
};

vec2 planeOffset(int from, int to, int columns_at) {
  vec3 gap = texelFetch(layout_texels, columns_at + to * kColumnTexels).xyz -
             texelFetch(layout_texels, columns_at + from * kColumnTexels).xyz;
  return vec2(dot(gap, texelFetch(layout_texels, columns_at + from * kColumnTexels + 1).xyz),
              dot(gap, texelFetch(layout_texels, columns_at + from * kColumnTexels + 2).xyz));
}

// Position in the unit square by the R2 sequence: any first n strands of a face are spread evenly. A jitter that
// shrinks with the index hides the sequence's rows without breaking that.
vec2 facePoint(uint face, uint index, uint key) {
  const uint seed = uint(counts.w);
  vec2 shift = vec2(unitFloat(hash(face, seed)), unitFloat(hash(face + 0x51ed27u, seed)));
  vec2 spread = vec2(unitFloat((index + 1u) * 3242174889u), unitFloat((index + 1u) * 2447445414u));
  vec2 jitter = (vec2(randomOf(key, 1u), randomOf(key, 2u)) - 0.5) * 0.7 * inversesqrt(float(index) + 1.0);
  return fract(shift + spread + jitter);
}

void weighQuad(vec2 p, ivec4 columns, int columns_at, inout Strand strand) {
  float u = p.x, v = p.y, iu = 1.0 - u, iv = 1.0 - v;
  float u0 = iu * iu * (1.0 + 2.0 * u), u1 = 1.0 - u0, v0 = iv * iv * (1.0 + 2.0 * v), v1 = 1.0 - v0;
  float tu0 = u * iu * iu, tu1 = u * u * iu, tv0 = v * iv * iv, tv1 = v * v * iv;
  strand.blend = vec4(iu * iv, u * iv, u * v, iu * v);
  strand.weight = vec4(iv * u0 + iu * v0, iv * u1 + u * v0, v * u1 + u * v1, v * u0 + iu * v1) - strand.blend;
  vec4 to_next = vec4(iv * tu0, u * tv0, v * tu1, iu * tv1);  // edges 0-1, 1-2, 2-3, 3-0 from their first corner
  vec4 to_last = vec4(iu * tv0, iv * tu1, u * tv1, v * tu0);  // the same edges from their second corner, turned by one
  for (int k = 0; k < 4; ++k) {
    vec2 d = to_next[k] * planeOffset(columns[k], columns[(k + 1) & 3], columns_at) +
             to_last[k] * planeOffset(columns[k], columns[(k + 3) & 3], columns_at);
    strand.along_u[k] = d.x;
    strand.along_v[k] = d.y;
  }
}

void weighTriangle(vec2 p, ivec4 columns, int columns_at, inout Strand strand) {
  if (p.x + p.y > 1.0) p = 1.0 - p;
  vec3 b = vec3(1.0 - p.x - p.y, p.x, p.y);
  float bubble = b.x * b.y * b.z;
  strand.blend = vec4(b, 0.0);
  strand.weight = vec4(b * b * (3.0 - 2.0 * b) + 2.0 * bubble, 0.0);
  for (int k = 0; k < 3; ++k) {
    int next = (k + 1) % 3, last = (k + 2) % 3;
    vec2 d = (b[k] * b[k] * b[next] + 0.5 * bubble) * planeOffset(columns[k], columns[next], columns_at) +
             (b[k] * b[k] * b[last] + 0.5 * bubble) * planeOffset(columns[k], columns[last], columns_at);
    strand.along_u[k] = d.x;
    strand.along_v[k] = d.y;
  }
}

// The clump is the nearest of the jittered points of a lattice in rest scalp space, so clumps cross faces freely.
void joinClump(ivec4 columns, int corners, int columns_at, inout Strand strand) {
  vec3 root = vec3(0.0);
  for (int k = 0; k < corners; ++k)
    root += strand.blend[k] * texelFetch(layout_texels, columns_at + columns[k] * kColumnTexels).xyz;
  float size = max(clumping.y, 1e-4);
  vec3 cell = root / size - 0.5;
  ivec3 base = ivec3(floor(cell));
  vec3 nearest = vec3(0.0);
  float nearest_squared = 1e30;
  for (int i = 0; i < 8; ++i) {
    ivec3 at = base + ivec3(i & 1, (i >> 1) & 1, i >> 2);
    uint key = hash(uint(at.x) * 73856093u ^ uint(at.y) * 19349663u ^ uint(at.z) * 83492791u, uint(counts.w));
    vec3 gap = vec3(at) + 0.8 * (vec3(randomOf(key, 1u), randomOf(key, 2u), randomOf(key, 3u)) - 0.5) - cell;
    float squared = dot(gap, gap);
    if (squared < nearest_squared) {
      nearest_squared = squared;
      nearest = gap;
      strand.clump_key = key;
    }
  }
  vec3 pull = nearest * size * clumping.x * (1.0 - strand.loose) * (0.75 + 0.25 * randomOf(strand.key, 5u));
  for (int k = 0; k < corners; ++k) {
    strand.pull_u[k] =
        strand.blend[k] * dot(pull, texelFetch(layout_texels, columns_at + columns[k] * kColumnTexels + 1).xyz);
    strand.pull_v[k] =
        strand.blend[k] * dot(pull, texelFetch(layout_texels, columns_at + columns[k] * kColumnTexels + 2).xyz);
  }
}

Strand makeStrand(int number) {
  int entry = 0, high = counts.y - 1;
  while (entry < high) {
    int middle = (entry + high) >> 1;
    if (texelFetch(table_texels, counts.z + middle * kTableTexels).x > float(number))
      high = middle;
    else
      entry = middle + 1;
  }
  vec4 dealt = texelFetch(table_texels, counts.z + entry * kTableTexels);
  int low = int(dealt.y);
  vec4 first = texelFetch(layout_texels, low * kFaceTexels), extent = texelFetch(layout_texels, low * kFaceTexels + 2);
  ivec4 columns = ivec4(texelFetch(layout_texels, low * kFaceTexels + 1));
  int corners = first.w < 0.0 ? 3 : 4, columns_at = counts.x * kFaceTexels;
  if (corners == 3) {
    first.w = first.z;
    columns.w = columns.z;
  }
  Strand strand;
  strand.first = ivec4(first);
  strand.layers = int(extent.x);
  uint index = uint(number - int(dealt.w));
  strand.key = hash(hash(uint(low), index), uint(counts.w));
  strand.segments = dealt.z > 0.0 ? dealt.z : detail.w;
  // A face's strands leave one after another as detail falls, each fading; faces do not do so at the same moment.
  float rank = (float(index) + unitFloat(hash(uint(low) + 0x2545f4u, uint(counts.w)))) / max(extent.z - extent.y, 1.0);
  strand.gain = detail.z * clamp((detail.y - rank) / (detail.y - detail.x), 0.0, 1.0);
  strand.along_u = strand.along_v = strand.pull_u = strand.pull_v = vec4(0.0);
  strand.clump_key = 0u;
  strand.loose = randomOf(strand.key, 3u) < clumping.w ? 1.0 : 0.0;
  vec2 point = facePoint(uint(low), index, strand.key);
  if (corners == 4)
    weighQuad(point, columns, columns_at, strand);
  else
    weighTriangle(point, columns, columns_at, strand);
  joinClump(columns, corners, columns_at, strand);
  // A clump's strands end near each other, as cut locks do; the square keeps most strands long.
  float early = mix(randomOf(strand.key, 4u), randomOf(strand.clump_key, 4u), 0.2 * clumping.x);
  float cut = 0.0;
  for (int k = 0; k < corners; ++k)
    cut += strand.blend[k] * texelFetch(layout_texels, columns_at + columns[k] * kColumnTexels).w;
  strand.end = cut * (1.0 - shape.x * early * early);
  return strand;
}

// How far a clump has closed at `t` of the bundle's length: open at the root, closed past the middle, opening again
// towards the end, or a cut would look torn into locks.
float clumpClosing(float t, uint clump_key) {
  float reach = 0.3 + 0.4 * randomOf(clump_key, 6u);
  float opens_again = 0.35 + 0.4 * randomOf(clump_key, 7u);
  return smoothstep(0.0, reach, t) * (1.0 - opens_again * smoothstep(0.6, 1.0, t));
}

LayerPoint layerPoint(in Strand strand, int layer) {
  LayerPoint point = LayerPoint(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0));
  float closing = clumpClosing(float(layer) / float(strand.layers - 1), strand.clump_key);
  for (int k = 0; k < 4; ++k) {
    int at = (strand.first[k] + layer) * kVertexTexels;
    vec4 p = texelFetch(vertex_texels, at), du = texelFetch(vertex_texels, at + 1),
         dv = texelFetch(vertex_texels, at + 2);
    point.position += strand.weight[k] * p.xyz + (strand.along_u[k] + closing * strand.pull_u[k]) * du.xyz +
                      (strand.along_v[k] + closing * strand.pull_v[k]) * dv.xyz;
    point.axis_u += strand.blend[k] * du.xyz;
    point.axis_v += strand.blend[k] * dv.xyz;
    point.light += strand.blend[k] * vec3(p.w, floor(vec2(du.w, dv.w)) / kDepthSteps);
    point.behind += strand.blend[k] * fract(vec2(du.w, dv.w)) * kDeepest;
  }
  return point;
}

// The layers around a segment: `before` and `after` are mirrored where the strand has none.
struct LayerWindow {
  vec3 before;
  LayerPoint from, to;
  vec3 after;
};

vec3 layerAfter(in Strand strand, int layer, vec3 last, vec3 here) {
  return layer < strand.layers ? layerPoint(strand, layer).position : 2.0 * here - last;
}

LayerWindow layerWindow(in Strand strand, int layer) {
  LayerWindow window;
  window.from = layerPoint(strand, layer);
  window.to = layerPoint(strand, layer + 1);
  window.before = layer > 0 ? layerPoint(strand, layer - 1).position : 2.0 * window.from.position - window.to.position;
  window.after = layerAfter(strand, layer + 2, window.from.position, window.to.position);
  return window;
}

vec3 unitOr(vec3 v, vec3 otherwise) {
  float squared = dot(v, v);
  return squared > 1e-16 ? v * inversesqrt(squared) : otherwise;
}

// Sideways wander, curl and frizz at parameter s: xy the offset (m) in the strand's frame, zw its derivative by s.
vec4 sideways(in Strand strand, float s) {
  float per_layer = 1.0 / float(strand.layers - 1), t = s * per_layer;
  float grow = t * (1.6 - 0.6 * t), growth = 1.6 - 1.2 * t;
  float angle = 2.0 * kPi * randomOf(strand.key, 8u), reach = sqrt(randomOf(strand.key, 9u));
  reach *= shape.y * (1.0 + 5.0 * strand.loose);
  vec2 away = reach * vec2(cos(angle), sin(angle));
  float bend = 2.0 * kPi * (t * (0.7 + 0.8 * randomOf(strand.key, 10u)) + randomOf(strand.key, 11u));
  float bend_rate = 2.0 * kPi * (0.7 + 0.8 * randomOf(strand.key, 10u));
  vec2 offset = away * grow * (0.6 + 0.4 * sin(bend));
  vec2 rate = away * (growth * (0.6 + 0.4 * sin(bend)) + grow * 0.4 * cos(bend) * bend_rate);

  float turn_rate = 2.0 * kPi * shape.w * (0.85 + 0.3 * randomOf(strand.clump_key, 8u));
  float turn = turn_rate * t + 2.0 * kPi * randomOf(strand.clump_key, 9u) + 0.8 * (randomOf(strand.key, 12u) - 0.5);
  float radius = shape.z * (0.8 + 0.4 * randomOf(strand.key, 13u));
  vec2 round = vec2(cos(turn), sin(turn)), round_rate = vec2(-round.y, round.x) * turn_rate;
  float opening = smoothstep(0.0, 0.35, t), x = clamp(t / 0.35, 0.0, 1.0);
  offset += radius * opening * round;
  rate += radius * (opening * round_rate + 6.0 * x * (1.0 - x) / 0.35 * round);

  vec2 wave_rate = 2.0 * kPi * (2.5 + 4.0 * vec2(randomOf(strand.key, 14u), randomOf(strand.key, 15u)));
  vec2 wave = wave_rate * t + 2.0 * kPi * vec2(randomOf(strand.key, 16u), randomOf(strand.key, 17u));
  offset += clumping.z * grow * sin(wave);
  rate += clumping.z * (growth * sin(wave) + grow * cos(wave) * wave_rate);
  return vec4(offset, rate * per_layer);
}

CurvePoint curvePoint(in Strand strand, in LayerWindow window, float s, float fraction) {
  vec3 p0 = window.before, p1 = window.from.position, p2 = window.to.position, p3 = window.after;
  float f = fraction;
  vec3 c1 = 0.5 * (p2 - p0), c2 = p0 - 2.5 * p1 + 2.0 * p2 - 0.5 * p3, c3 = 1.5 * (p1 - p2) + 0.5 * (p3 - p0);
  vec3 base = p1 + f * (c1 + f * (c2 + f * c3));
  vec3 slope = c1 + f * (2.0 * c2 + f * 3.0 * c3);
  vec3 axis = unitOr(slope, vec3(0.0, -1.0, 0.0));
  vec3 aside = mix(window.from.axis_u, window.to.axis_u, f);
  aside = unitOr(aside - axis * dot(axis, aside), vec3(1.0, 0.0, 0.0));
  vec3 across = cross(axis, aside);
  vec4 bend = sideways(strand, s);
  CurvePoint point;
  point.position = base + aside * bend.x + across * bend.y;
  point.tangent = unitOr(slope + aside * bend.z + across * bend.w, axis);
  point.light = mix(window.from.light, window.to.light, f);
  point.behind = mix(window.from.behind, window.to.behind, f);
  point.along = strand.end > 0.0 ? s / strand.end : 0.0;
  return point;
}

// Ribbon point `index` of a strand sits at index / (segments a layer), cut at the strand's end. Both strand paths ask
// here.
float pointParameter(in Strand strand, int index) { return min(float(index) / strand.segments, strand.end); }

// Moves the window on to the layer that s lies in; with less than a segment a layer some are passed over.
void moveWindow(in Strand strand, int wanted, inout int layer, inout LayerWindow window) {
  if (wanted == layer + 1) {
    window.before = window.from.position;
    window.from = window.to;
    window.to = layerPoint(strand, wanted + 1);
    window.after = layerAfter(strand, wanted + 2, window.from.position, window.to.position);
  } else if (wanted > layer) {
    window = layerWindow(strand, wanted);
  }
  layer = wanted;
}
