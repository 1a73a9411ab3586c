// Shadows of the key light: deep opacity maps of the hairs, depth maps of the bodies.
// Source: Yuksel and Keyser 2008, Deep Opacity Maps: opacity layers start at the depth where the light first meets
// hair.

layout(binding = kUnitOpacityNear) uniform sampler2DArray opacity_near;  // layers 0..3
layout(binding = kUnitOpacityFar) uniform sampler2DArray opacity_far;    // layers 4..6, all
layout(binding = kUnitHairDepth) uniform sampler2DArray hair_depth;
layout(binding = kUnitBodyInHairDepth) uniform sampler2DArrayShadow body_in_hair_depth;
layout(binding = kUnitBodyDepth) uniform sampler2DArrayShadow body_depth;
layout(binding = kUnitBodyDepthPlain) uniform sampler2DArray body_depth_plain;

// Light-space texture coordinates and depth of a world point in hair shadow map `map`; outside of [0, 1] where not
// covered.
vec3 hairShadowCoordinates(int map, vec3 world) {
  vec4 clip = hair_shadow[map] * vec4(world, 1.0);
  return clip.xyz * 0.5 + 0.5;
}

// Where a place of the map lies in the array of textures, off the tile's border by half a texel of a level so that
// neighbours do not bleed in.
vec3 hairShadowTexel(int map, vec2 at, float level) {
  float half_texel = min(0.5 * exp2(ceil(level)) / hair_shadow_size[map].y, 0.5);
  vec4 tile = hair_shadow_tile[map];
  return vec3(tile.xy + clamp(at, half_texel, 1.0 - half_texel) * vec2(tile.z, tile.z * opacity.z), tile.w);
}

vec3 hairShadowTexel(int map, vec2 at) { return hairShadowTexel(map, at, 0.0); }

// What the layers of a texel hold up to `behind` (m) its first hair. Within a layer it grows linearly; layers thicken
// geometrically, since what lies deep needs less resolution.
float heldUpTo(vec4 near, vec4 far, float behind, float thickness) {
  // held[0] = 0 at the first hair; held[k] at the end of layer k, which lies at thickness (g^k - 1) / (g - 1).
  const float kRate = log2(kLayerGrowth);
  float depth = max(behind, 0.0) / thickness;
  float layer = min(floor(log2(1.0 + (kLayerGrowth - 1.0) * depth) / kRate), opacity.x);
  float span = exp2(kRate * layer);
  float into = clamp((depth - (span - 1.0) / (kLayerGrowth - 1.0)) / span, 0.0, 1.0);
  // The point's own layer counts in part and the one before it for the rest: weights instead of an indexed array, which
  // software rasterizers keep in slow memory.
  vec4 from_near = vec4(1.0, 2.0, 3.0, 4.0) - layer, from_far = from_near + 4.0;
  vec4 in_near = max(1.0 - abs(from_near), 0.0) * (1.0 - into), in_far = max(1.0 - abs(from_far), 0.0) * (1.0 - into);
  if (layer < opacity.x) {
    in_near += max(1.0 - abs(from_near - 1.0), 0.0) * into;
    in_far += max(1.0 - abs(from_far - 1.0), 0.0) * into;
  } else {
    in_far.w += into;
  }
  return opacity.y * (dot(in_near, near) + dot(in_far, far));
}

// Optical depth (expected number of hairs crossed, weighted by strength) between the key light and a point, and that of
// the hair behind it as far as light comes back, by one texel.
vec2 depthsInTexel(int map, ivec3 texel, float depth) {
  float behind = (depth - texelFetch(hair_depth, texel, 0).r) * hair_shadow_size[map].z;
  vec4 near = texelFetch(opacity_near, texel, 0), far = texelFetch(opacity_far, texel, 0);
  float before = heldUpTo(near, far, behind, hair_shadow_size[map].w);
  return vec2(before, heldUpTo(near, far, behind + kBackReach, hair_shadow_size[map].w) - before);
}

bool coveredByMap(vec2 at) { return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0))); }

// Each texel has its own first hair: depths are sought in each of the four about the point and then interpolated, for
// between a texel with hair and one without lies no surface.
vec2 hairOpticalDepths(int map, vec3 at) {
  if (!coveredByMap(at.xy)) return vec2(0.0);
  vec3 texel = hairShadowTexel(map, at.xy);
  vec2 corner = texel.xy * vec2(textureSize(hair_depth, 0).xy) - 0.5, low = floor(corner), part = corner - low;
  ivec3 place = ivec3(ivec2(low), int(texel.z));
  vec2 below = mix(depthsInTexel(map, place, at.z), depthsInTexel(map, place + ivec3(1, 0, 0), at.z), part.x);
  vec2 above = mix(depthsInTexel(map, place + ivec3(0, 1, 0), at.z), depthsInTexel(map, place + ivec3(1, 1, 0), at.z), part.x);
  return mix(below, above, part.y);
}

// Of the texel nearest to a point, one of many whose sum is sought: the first of both, where hair nearer above the point
// than kNear (m) counts less and less; and that of all the texel's hair.
const float kNear = 0.01;
vec2 hairBeforeAndAll(int map, vec3 at) {
  if (!coveredByMap(at.xy)) return vec2(0.0);
  vec3 place = hairShadowTexel(map, at.xy);
  ivec3 texel = ivec3(place.xy * vec2(textureSize(hair_depth, 0).xy), int(place.z));
  float above = (at.z - texelFetch(hair_depth, texel, 0).r) * hair_shadow_size[map].z;
  vec4 near = texelFetch(opacity_near, texel, 0), far = texelFetch(opacity_far, texel, 0);
  float before = clamp(above / kNear, 0.0, 1.0) * heldUpTo(near, far, above, hair_shadow_size[map].w);
  return vec2(before, opacity.y * far.w);
}

// Light left after the bodies, for a point of hair.
float bodyLightOnHair(int map, vec3 at) {
  if (opacity.w == 0.0) return 1.0;
  float reference = at.z - 0.004 / hair_shadow_size[map].z;
  return texture(body_in_hair_depth, vec4(hairShadowTexel(map, at.xy), reference));
}

// A lamp of some size: hair's shadow widens with the distance from the hair. m at the hair; rad.
const float kMinRadius = 0.008, kLampAngle = 0.1;
const int kTaps = 12, kNearTaps = 24;

// Taps on a disc of radius 1 lie on a spiral of golden angles (Vogel 1979): the first has this direction, the next is
// turned by one angle more, for turning costs less than a sine.
const vec2 kFirstTap = vec2(1.0, 0.0);
vec2 nextTap(vec2 way) { return vec2(-0.737369 * way.x - 0.675490 * way.y, 0.675490 * way.x - 0.737369 * way.y); }

// Tap `i` of so many, in its direction.
vec2 discTap(int i, float taps, vec2 way) { return sqrt((float(i) + 0.5) / taps) * way; }

// Optical depth of all hair of a map along the light, averaged over texels of a level.
float wholeOpticalDepth(int map, vec2 at, float level) {
  return opacity.y * textureLod(opacity_far, hairShadowTexel(map, at, level), level).w;
}

// For a point behind all hair of the map, as the ground is: `taps` taps as wide as they lie apart, so that none is seen.
float lightBehindHair(int map, vec3 at, int taps) {
  float above = (at.z - 0.5) * hair_shadow_size[map].z;  // m, from the hair's middle
  float reach = (kMinRadius + 0.5 * kLampAngle * above) / hair_shadow_size[map].x;
  float level = clamp(log2(reach * hair_shadow_size[map].y * 0.5), 0.0, float(kOpacityLevels - 1));
  float sum = 0.0;
  vec2 way = kFirstTap;
  for (int i = 0; i < taps; ++i, way = nextTap(way)) {
    vec2 tap = at.xy + reach * discTap(i, float(kTaps), way);
    bool inside = all(greaterThan(tap, vec2(0.0))) && all(lessThan(tap, vec2(1.0)));
    sum += inside ? exp(-wholeOpticalDepth(map, tap, level)) : 1.0;
  }
  return sum / float(kTaps);
}

// For a point among the map's hair: how far above lies the hair that may shade it? Sought over a wide disc: the mean of
// what is found, so that it does not leap from one strand to the next.
float lightBetweenHair(int map, vec3 at, int sought) {
  const float kSought = 0.03;  // m
  float above = 0.0, found = 0.0;
  vec2 way = kFirstTap;
  for (int i = 0; i < sought; ++i, way = nextTap(way)) {
    vec2 tap = kSought * discTap(i, 9.0, way);
    float first = textureLod(hair_depth, hairShadowTexel(map, at.xy + tap / hair_shadow_size[map].x), 0.0).r;
    float height = (at.z - first) * hair_shadow_size[map].z, weight = clamp(height / kNear, 0.0, 1.0);
    above += weight * height;
    found += weight;
  }
  above /= max(found, 1e-6);
  float reach = (kMinRadius + 0.5 * kLampAngle * above) / hair_shadow_size[map].x, sum = 0.0;
  // Fine texels are rougher than the taps lie apart. So texels say which share of the hair stands above the point, all
  // of it where they hold less than kFew, and averages of texels how much hair there is.
  const float kFew = 0.1;
  int taps = sought > 0 ? kNearTaps : 0;
  float level = clamp(log2(0.25 * reach * hair_shadow_size[map].y), 0.0, float(kOpacityLevels - 1));
  vec2 hair = vec2(0.0);
  way = kFirstTap;
  for (int i = 0; i < taps; ++i, way = nextTap(way))
    hair += hairBeforeAndAll(map, vec3(at.xy + reach * discTap(i, float(kNearTaps), way), at.z));
  float share = (hair.x + kFew) / (hair.y + kFew);
  way = kFirstTap;
  for (int i = 0; i < taps; ++i, way = nextTap(way)) {
    vec2 tap = at.xy + reach * discTap(i, float(kNearTaps), way);
    sum += coveredByMap(tap) ? exp(-share * wholeOpticalDepth(map, tap, level)) : 1.0;
  }
  return sum / float(kNearTaps);
}

// Light of the key left after the hair of a map, for a point of body or ground: averaged over a disc that widens with
// the distance from the hair. Software rasterizers run through both sides of a branch but skip a loop without turns: so
// it is counts that say what is left out.
float lightThroughHair(int map, vec3 world) {
  vec3 at = hairShadowCoordinates(map, world);
  vec2 beyond = max(-at.xy, at.xy - 1.0) * hair_shadow_size[map].x;
  bool behind = at.z >= 1.0, covered = max(beyond.x, beyond.y) <= (behind ? 0.1 : 0.0);
  // Where the coarsest texels around the point hold no hair, none can be found.
  bool near = covered && !behind && wholeOpticalDepth(map, at.xy, float(kOpacityLevels - 1)) > 0.0;
  float below = lightBehindHair(map, at, covered && behind ? kTaps : 0), between = lightBetweenHair(map, at, near ? 9 : 0);
  return covered && behind ? below : near ? between : 1.0;
}

// After all hairs that may stand above the point.
float hairLightOnSurface(vec3 world) {
  float light = 1.0;
  if (to_key.w == 0.0) return light;
  vec2 at = vec2(dot(shadow_grid_x.xyz, world) + shadow_grid_x.w, dot(shadow_grid_y.xyz, world) + shadow_grid_y.w);
  ivec2 cell = ivec2(floor(at));
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(kShadowGrid)))) return light;
  ivec4 maps = shadow_grid[cell.y * kShadowGrid + cell.x];
  for (int word = 0; word < 4; ++word) {
    uint left = uint(word == 0 ? maps.x : word == 1 ? maps.y : word == 2 ? maps.z : maps.w);
    for (; left != 0u; left &= left - 1u) light *= lightThroughHair(32 * word + findLSB(left), world);
  }
  return light;
}

// x: how far above a point the bodies stand that may shade it (m), over a disc: the mean of what is found. y: the share
// of the taps that found one. Surfaces that the light grazes rise towards it themselves: `rise` (m a m) counts for
// nothing.
const float kBodyReach = 0.04;  // m
const float kMinFacing = -0.27;  // a surface turned farther from the light gets none, wrapped or not (surface.glsl)
const int kSoughtTaps = 8;
const int kBodyTaps = 12, kGroundTaps = 32;  // a plain ground shows every tap
const float kEdge = 0.02;  // share of taps, from full light and from full shadow, that is no edge
vec2 bodiesAbove(int map, vec3 at, vec2 scale, float rise, int sought) {
  vec2 sum = vec2(0.0), way = kFirstTap;
  for (int i = 0; i < sought; ++i, way = nextTap(way)) {
    vec2 tap = kBodyReach * discTap(i, float(kSoughtTaps), way);
    float first = textureLod(body_depth_plain, vec3(at.xy + tap * scale.x, map), 0.0).r;
    float height = (at.z - first) / scale.y - rise * length(tap), weight = clamp((height - 0.002) / 0.006, 0.0, 1.0);
    if (first >= 1.0) weight = 0.0;
    sum += weight * vec2(height, 1.0);
  }
  return vec2(sum.x / max(sum.y, 1e-6), sum.y / float(kSoughtTaps));
}

// Light left after the bodies, for a point of body or ground, in the first map that covers it: percentage-closer
// filtering over a disc as wide as the lamp draws the shadow's edge out (Fernando 2005). Full light and full shadow need
// no filter. most: taps.
float bodyLightOnSurface(vec3 world, vec3 normal, int most) {
  for (int map = 0; map < int(opacity.w); ++map) {
    mat4 to_map = body_shadow[map];
    vec3 at = (to_map * vec4(world + normal * 0.012, 1.0)).xyz * 0.5 + 0.5;
    if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) continue;
    // Of the map, a metre: of its side and of its depth.
    vec2 scale = 0.5 * vec2(length(vec3(to_map[0].x, to_map[1].x, to_map[2].x)),
                            length(vec3(to_map[0].z, to_map[1].z, to_map[2].z)));
    float towards = dot(normal, to_key.xyz), facing = max(towards, 0.3), rise = sqrt(1.0 - facing * facing) / facing;
    vec2 above = bodiesAbove(map, at, scale, rise, towards > kMinFacing ? kSoughtTaps : 0);
    float texel = 2.0 / (float(textureSize(body_depth, 0).x) * scale.x);  // m
    float reach = clamp(0.5 * kLampAngle * above.x, texel, kBodyReach), sum = 0.0;
    int taps = above.y > kEdge && above.y < 1.0 - kEdge ? most : 0;
    vec2 way = kFirstTap;
    for (int i = 0; i < taps; ++i, way = nextTap(way)) {
      vec2 tap = reach * discTap(i, float(most), way);
      // The ground lies behind the frustum around the bodies, and behind every one of them.
      float depth = min(at.z - 0.0012 - rise * length(tap) * scale.y, 0.9988);
      sum += texture(body_depth, vec4(at.xy + tap * scale.x, map, depth));
    }
    return taps > 0 ? sum / float(most) : above.y > kEdge ? 0.0 : 1.0;
  }
  return 1.0;
}
