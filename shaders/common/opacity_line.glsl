// Opacity that a one-texel-wide line adds to a texel it crosses so that, summed over many, it equals the hairs'
// projected area: the diameter of the hairs that the strand stands for over the texel's size, times line length per
// texel touched (a line touches one texel a step of its longer axis).
float lineOpacity(in Strand strand, vec3 tangent) {
  vec2 direction = (mat3(hair_shadow[draw.w]) * tangent).xy * hair_shadow_size[draw.w].x;
  float longer = max(abs(direction.x), abs(direction.y));
  float per_texel = longer > 1e-6 ? length(direction) / longer : 1.0;
  return width.z * strand.gain * per_texel * hair_shadow_size[draw.w].y / hair_shadow_size[draw.w].x;
}
