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

#include "common/skin.glsl"

layout(binding = kUnitVertices) uniform samplerBuffer vertex_texels;
layout(binding = kUnitLayout) uniform samplerBuffer layout_texels;
layout(binding = kUnitSkin) uniform usamplerBuffer skin_texels;  // see leaveSkin: of each face, layer by layer
layout(binding = kUnitTable) uniform samplerBuffer table_texels;  // which strands of which faces are drawn

const float kPi = 3.14159265358979;

#include "common/strand_share.glsl"

struct Strand {
  ivec4 first;  // first vertex of each corner's column; [3] repeats [2] with weight 0 in a triangle
  int layers;
  int face;        // of the layout
  vec4 weight;   // of positions
  vec4 along_u;  // of gradients du
  vec4 along_v;  // of gradients dv
  vec4 blend;      // linear weights: frames and light
  vec2 wisp;       // m in the rest scalp's plane: from the root to the middle of its wisp,
  vec2 clump;      // of its clump,
  vec2 lock;       // of its lock
  vec2 way;        // m of hair from the root to s layers at rest: s (x + y s)
  float end;       // curve parameter of the tip, in layers
  float metres;    // of hair to the tip
  uint key;        // hash keys of the strand,
  uint clump_key;  // of its clump,
  uint lock_key;   // of its lock
  float loose;     // 1 for a stray hair, else 0
  float fine;      // 1 for a short fine hair of the hairline, else 0
  float rim;       // 1 at the hairline .. 0 well inside
  vec2 astray;     // m a m of hair, in the rest scalp's plane: how a fine hair leaves the others
  vec2 shift;      // m, in the same: how far before the hairline it roots
  vec2 fan;        // m, in the same: e times how far it goes aside before it falls in with the others
  float hold;      // 0..1: how far it goes along with its groups
  float segments;  // a layer
  float gain;      // of width and opacity: how many strands this one stands for; 0: left out
  StrandShare share;  // of its root
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

// What a strand's root is at rest: the blend of its columns.
struct Root {
  vec3 rest, axis_u, axis_v;  // m, unit
  float cut;                  // layers at which the bundles around are cut
  float edge;                 // m to the hairline
  vec2 outward;               // in the scalp's plane, towards bare skin
};

Root rootOf(ivec4 columns, int corners, int columns_at, inout Strand strand) {
  Root root = Root(vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, vec2(0.0));
  strand.way = vec2(0.0);
  for (int k = 0; k < corners; ++k) {
    int at = columns_at + columns[k] * kColumnTexels;
    vec4 place = texelFetch(layout_texels, at);
    vec4 axis_u = texelFetch(layout_texels, at + 1), axis_v = texelFetch(layout_texels, at + 2);
    vec3 measures = texelFetch(layout_texels, at + 3).xyz;
    root.rest += strand.blend[k] * place.xyz;
    root.axis_u += strand.blend[k] * axis_u.xyz;
    root.axis_v += strand.blend[k] * axis_v.xyz;
    root.outward += strand.blend[k] * vec2(axis_u.w, axis_v.w);
    root.cut += strand.blend[k] * place.w;
    strand.way += strand.blend[k] * measures.xy;
    root.edge += strand.blend[k] * measures.z;
  }
  return root;
}

// m of hair from the root to s layers, and its rate by s.
vec2 wayAt(in Strand strand, float s) {
  return vec2(s * (strand.way.x + strand.way.y * s), strand.way.x + 2.0 * strand.way.y * s);
}

// Layers after m of hair.
float layersAt(in Strand strand, float metres) {
  float root = sqrt(max(strand.way.x * strand.way.x + 4.0 * strand.way.y * metres, 0.0));
  return 2.0 * metres / max(strand.way.x + root, 1e-6);
}

// A group of hairs that keep together.
struct Group {
  vec3 gap;  // from the root to its middle, in sizes of the group
  uint key;
};

// The nearest of the jittered points of a lattice in rest scalp space, so groups cross faces freely.
Group groupOf(vec3 root, float size, uint level) {
  vec3 cell = root / size - 0.5;
  ivec3 base = ivec3(floor(cell));
  Group group = Group(vec3(0.0), 0u);
  float nearest = 1e30;
  for (int i = 0; i < 8; ++i) {
    ivec3 at = base + ivec3(i & 1, (i >> 1) & 1, i >> 2);
    uint key = hash(uint(at.x) * 73856093u ^ uint(at.y) * 19349663u ^ uint(at.z) * 83492791u, uint(counts.w) + level);
    vec3 jitter = vec3(key & 1023u, (key >> 10u) & 1023u, (key >> 20u) & 1023u) * (1.0 / 1024.0);
    vec3 gap = vec3(at) + 0.8 * (jitter - 0.5) - cell;
    float squared = dot(gap, gap);
    if (squared < nearest) {
      nearest = squared;
      group.gap = gap;
      group.key = key;
    }
  }
  return group;
}

vec2 inPlane(in Root root, vec3 gap) { return vec2(dot(gap, root.axis_u), dot(gap, root.axis_v)); }

vec2 onCircle(float turn) { return vec2(cos(2.0 * kPi * turn), sin(2.0 * kPi * turn)); }

// Hairs keep together in wisps, wisps in clumps, clumps in locks.
void joinGroups(in Root root, inout Strand strand) {
  float size = max(clumping.y, 1e-4);
  Group clump = groupOf(root.rest, size, 0u), lock = groupOf(root.rest, kLockSize * size, 1u),
        wisp = groupOf(root.rest, kWispSize * size, 2u);
  strand.clump_key = clump.key;
  strand.lock_key = lock.key;
  strand.clump = size * inPlane(root, clump.gap);
  strand.lock = kLockSize * size * inPlane(root, lock.gap);
  strand.wisp = kWispSize * size * inPlane(root, wisp.gap);
  strand.fan = 2.718282 * variation.x * sqrt(randomOf(strand.key, 32u)) * onCircle(randomOf(strand.key, 33u));
  // Frizzy hairs leave their groups.
  float frizzy = min(clumping.z * strand.share.frizz * 200.0, 0.8) * randomOf(strand.key, 24u);
  strand.hold = (1.0 - strand.loose) * (1.0 - frizzy) * (0.75 + 0.25 * randomOf(strand.key, 5u));
}

// Towards the hairline fewer hairs grow, and more of them are short and fine.
void thinHairline(in Root root, inout Strand strand) {
  strand.rim = 0.0;
  strand.astray = strand.shift = vec2(0.0);
  if (waves.z <= 0.0) return;
  float ragged = 0.6 * (randomOf(strand.clump_key, 23u) - 0.5);  // a hairline is no smooth curve
  float inside = clamp(root.edge / waves.z + ragged, 0.0, 1.0);
  float chance = randomOf(strand.key, 18u), grown = 0.15 + 0.85 * smoothstep(0.0, 0.8, inside);
  strand.rim = 1.0 - inside;
  strand.fine = randomOf(strand.key, 19u) < waves.w * strand.rim ? 1.0 : 0.0;
  // Of fine hairs more are left than of others.
  if (chance > mix(grown, 1.0, 0.8 * strand.fine)) strand.gain = 0.0;
  strand.astray = strand.fine * (0.9 * randomOf(strand.key, 6u) - 0.3) * root.outward;
  // Some root before the others, alone or as a wisp.
  float alone = randomOf(strand.key, 31u), wisp = randomOf(strand.clump_key, 31u);
  float before = 0.35 * (alone * alone + wisp * wisp * wisp);
  strand.shift = strand.rim * waves.z * before * root.outward;
  strand.gain *= 1.0 - mix(0.3, 0.6, strand.fine) * strand.rim * alone;
}

// Where a strand ends. Locks and clumps are cut to lengths of their own, each clump to a point; stray hairs are often
// broken.
void cutStrand(in Root root, inout Strand strand) {
  float own = randomOf(strand.key, 4u), apart = length(strand.clump) / (0.6 * max(clumping.y, 1e-4));
  float early = 0.4 * own * own + 0.25 * randomOf(strand.clump_key, 4u) + 0.2 * randomOf(strand.lock_key, 4u) +
                0.15 * min(apart * apart, 1.0);
  strand.end = root.cut * (1.0 - shape.x * early);
  vec2 chance = vec2(randomOf(strand.key, 22u), randomOf(strand.key, 25u));
  if (strand.fine > 0.0) {
    strand.end = min(strand.end, layersAt(strand, 0.006 + 0.028 * chance.x * chance.x));
    strand.gain *= 0.25 + 0.3 * chance.y;
    strand.hold = 0.0;
    if (2.0 * strand.end <= float(strand.layers - 1)) strand.segments *= 2.0;
  } else if (strand.loose > 0.0) {
    if (chance.x < 0.4) strand.end = min(strand.end, layersAt(strand, 0.02 + 0.12 * chance.y));
    strand.gain *= 0.7;
  }
  strand.metres = wayAt(strand, strand.end).x;
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
  bool covered = extent.x < 0.0;
  strand.layers = int(abs(extent.x));
  strand.face = low;
  uint index = uint(number - int(dealt.w));
  strand.key = hash(hash(uint(low), index), uint(counts.w));
  strand.segments = dealt.z > 0.0 ? dealt.z : detail.w;
  // A face's strands leave one after another as detail falls, each fading; faces do not do so at the same moment.
  float rank = (float(index) + unitFloat(hash(uint(low) + 0x2545f4u, uint(counts.w)))) / max(extent.z - extent.y, 1.0);
  strand.gain = detail.z * clamp((detail.y - rank) / (detail.y - detail.x), 0.0, 1.0);
  strand.along_u = strand.along_v = vec4(0.0);
  strand.loose = !covered && randomOf(strand.key, 3u) < clumping.w ? 1.0 : 0.0;
  strand.fine = 0.0;
  vec2 point = facePoint(uint(low), index, strand.key);
  if (corners == 4)
    weighQuad(point, columns, columns_at, strand);
  else
    weighTriangle(point, columns, columns_at, strand);
  Root root = rootOf(columns, corners, columns_at, strand);
  root.edge += extent.w * (corners == 4 ? 16.0 * point.x * point.y * (1.0 - point.x) * (1.0 - point.y)
                                        : 27.0 * strand.blend.x * strand.blend.y * strand.blend.z);
  strand.share = shareOfRoot(columns, corners, strand.blend);
  joinGroups(root, strand);
  thinHairline(root, strand);
  if (covered) strand.fan = strand.shift = vec2(0.0);  // nothing leaves its place under a hat
  cutStrand(root, strand);
  return strand;
}

// How far a clump has closed at `t` of the bundle's length: open at the root, closed past the middle, opening again
// towards the end, or a cut would look torn into locks.
float clumpClosing(float t, uint clump_key) {
  float reach = 0.3 + 0.4 * randomOf(clump_key, 6u);
  float opens_again = 0.35 + 0.4 * randomOf(clump_key, 7u);
  return smoothstep(0.0, reach, t) * (1.0 - opens_again * smoothstep(0.6, 1.0, t));
}

// Likewise a lock.
float lockClosing(float t) { return smoothstep(0.1, 0.7, t) * (1.0 - 0.6 * smoothstep(0.7, 1.0, t)); }

// m in the rest scalp's plane: how far a strand has been drawn aside at a layer, by its groups or as a fine hair.
vec2 groupPull(in Strand strand, float layer) {
  float way = wayAt(strand, layer).x, far = way / kFanReach;
  vec2 own = strand.shift + far * exp(-far) * strand.fan;
  if (strand.fine > 0.0) return own + way * strand.astray;
  float t = layer / float(strand.layers - 1);
  vec2 pull = strand.hold * groups.y * smoothstep(0.0, 0.25, t) * strand.wisp;
  float clump = clumping.x;
  if (shares.x > 0) clump *= strand.share.of.y * shareAlong(layer / max(strand.end, 1e-3), 0).y;
  pull += strand.hold * clump * clumpClosing(t, strand.clump_key) * (strand.clump - pull);
  return own + pull + strand.hold * groups.x * lockClosing(t) * (strand.lock - pull);
}

LayerPoint layerPoint(in Strand strand, int layer) {
  LayerPoint point = LayerPoint(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0));
  for (int k = 0; k < 4; ++k) {
    int at = (strand.first[k] + layer) * kVertexTexels;
    vec4 p = texelFetch(vertex_texels, at), du = texelFetch(vertex_texels, at + 1),
         dv = texelFetch(vertex_texels, at + 2);
    point.position += strand.weight[k] * p.xyz + strand.along_u[k] * du.xyz + strand.along_v[k] * dv.xyz;
    point.axis_u += strand.blend[k] * du.xyz;
    point.axis_v += strand.blend[k] * dv.xyz;
    point.light += strand.blend[k] * vec3(p.w, floor(vec2(du.w, dv.w)) / kDepthSteps);
    point.behind += strand.blend[k] * fract(vec2(du.w, dv.w)) * kDeepest;
  }
  // Where bundles fan out, groups close by no more than this of what lies between their roots.
  point.axis_u *= kMaxSpread / max(length(point.axis_u), kMaxSpread);
  point.axis_v *= kMaxSpread / max(length(point.axis_v), kMaxSpread);
  vec2 pull = groupPull(strand, float(layer));
  point.position += pull.x * point.axis_u + pull.y * point.axis_v;
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

// By a root to full precision: what it turns may be long.
vec3 unitOr(vec3 v, vec3 otherwise) {
  float squared = dot(v, v);
  precise vec3 unit = v / sqrt(max(squared, 1e-16));
  return squared > 1e-16 ? unit : otherwise;
}

#include "common/strand_bend.glsl"

int layerOf(in Strand strand, float s) { return clamp(int(s), 0, strand.layers - 2); }

uvec2 skinNear(in Strand strand, int layer) {
  return texelFetch(skin_texels, strand.face * skin_count.y + layer).xy;
}

// The points of a strand are asked for one after the other from the root on, where there is skin; lift: see leaveSkin.
CurvePoint curvePoint(in Strand strand, in LayerWindow window, float s, float fraction, inout SkinLift lift) {
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
  vec3 along = slope + aside * bend.z + across * bend.w;
  if (strand.loose + strand.fine > 0.0) {
    vec3 outward = unitOr(base - center.xyz, vec3(0.0));
    outward -= axis * dot(axis, outward);
    vec2 stray = lifted(strand, s);
    point.position += stray.x * outward;
    along += stray.y * outward;
  }
  along = unitOr(along, axis);
  int layer = layerOf(strand, s);
  if (skin_count.x > 0) {
    if (layer != lift.layer) meetSkin(skinNear(strand, layer), layer, p0, p1, p2, p3, mostBent(strand), lift);
    leaveSkin(s, lift, point.position, along);
  }
  point.tangent = unitOr(along, axis);
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
