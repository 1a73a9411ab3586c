// What the lines of a hair add to each deep opacity layer of its tile, in steps of 1 / kOpacitySteps: kOpacitySums
// layers of an image as large as a whole tile.
layout(binding = kImageSums, r32ui) uniform restrict uimage2DArray opacity_sums;

// Of the bound hair's tile in textures of so many texels: left, bottom, layer.
ivec3 tileOrigin(ivec2 texels) {
  vec4 tile = hair_shadow_tile[draw.w];
  return ivec3(vec3(tile.xy * vec2(texels), tile.w) + 0.5);
}
