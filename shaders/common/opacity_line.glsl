// Opacity that a one-texel-wide line adds to a texel it crosses so that, summed over many, it equals the hairs'
// projected area: the diameter of the hairs that the strand stands for over the texel's size, times line length per
// texel touched (a line touches one texel a step of its longer axis).
float lineOpacity(in Strand strand, in CurvePoint point) {
  vec2 direction = (mat3(hair_shadow[draw.w]) * point.tangent).xy * hair_shadow_size[draw.w].x;
  float longer = max(abs(direction.x), abs(direction.y));
  float per_texel = longer > 1e-6 ? length(direction) / longer : 1.0;
  float opacity = width.z * strand.gain * per_texel * hair_shadow_size[draw.w].y / hair_shadow_size[draw.w].x;
  return shares.x > 0 ? opacity * strand.share.of.x * shareAlong(point.along, 0).x : opacity;
}
