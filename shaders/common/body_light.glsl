// Light that a point of a body sends to the eye.
#include "common/shadow.glsl"
#include "common/surface.glsl"

vec3 bodyRadiance(vec3 world, vec3 normal) {
  vec3 to_eye = normalize(eye.xyz - world), n = normalize(normal);
  if (dot(n, to_eye) < 0.0)
    n = normalize(n - 1.02 * dot(n, to_eye) * to_eye);  // interpolated normals may tip over the rim
  vec3 albedo = body_color.rgb;
  float through_hair = 1.0, lit = 1.0;
  if (forward.w > 0.0) {
    through_hair = hairLightOnSurface(world);
    lit = bodyLightOnSurface(world, n) * through_hair;
  }
  // Under hair little of the sky and of the other lights arrives either; the key light's map is the only witness.
  float open = 0.7 + 0.3 * through_hair;
  vec3 radiance = lit * key.rgb * surfaceLight(n, to_key.xyz, to_eye, albedo, body_color.a);
  radiance += open * fill.rgb * surfaceLight(n, to_fill.xyz, to_eye, albedo, body_color.a);
  radiance += open * rim.rgb * surfaceLight(n, to_rim.xyz, to_eye, albedo, body_color.a);
  radiance += open * albedo * mix(ground_light.rgb, sky.rgb, 0.5 + 0.5 * n.y);
  return radiance;
}
