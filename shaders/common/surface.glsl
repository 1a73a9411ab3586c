// A matte surface under the scene's lights: Lambert, wrapped a little as skin-like clay is, and a soft GGX highlight.
// Sources: Walter et al. 2007 (GGX); Karis 2013 (visibility and Fresnel approximations).

float highlight(vec3 normal, vec3 to_light, vec3 to_eye, float roughness) {
  vec3 half_way = normalize(to_light + to_eye);
  float nh = max(dot(normal, half_way), 0.0), nl = max(dot(normal, to_light), 0.0), nv = max(dot(normal, to_eye), 1e-3);
  float a2 = roughness * roughness * roughness * roughness, d = nh * nh * (a2 - 1.0) + 1.0;
  float k = 0.5 * roughness * roughness;
  float visibility = 0.25 / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
  float fresnel = 0.04 + 0.96 * exp2(-8.35 * max(dot(half_way, to_eye), 0.0));
  return a2 / (3.14159265 * d * d) * visibility * fresnel * nl;
}

// Light that spreads beneath skin comes up past the shadow's edge, red farthest.
const vec3 kSkinWrap = vec3(0.27, 0.18, 0.14);

// As surfaceLight, with a wrap for each colour; the share of light that is sent back is kept.
vec3 wrappedLight(vec3 normal, vec3 to_light, vec3 to_eye, vec3 albedo, vec3 wrap, float roughness) {
  vec3 diffuse = max(dot(normal, to_light) + wrap, 0.0) / ((1.0 + wrap) * (1.0 + wrap));
  return albedo * diffuse / 3.14159265 + highlight(normal, to_light, to_eye, roughness);
}

vec3 surfaceLight(vec3 normal, vec3 to_light, vec3 to_eye, vec3 albedo, float roughness) {
  return wrappedLight(normal, to_light, to_eye, albedo, vec3(0.18), roughness);
}
