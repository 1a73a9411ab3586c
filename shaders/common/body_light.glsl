// Light that a point of a body sends to the eye.
#include "common/face.glsl"
#include "common/skin_tone.glsl"
#include "common/surface.glsl"
#include "common/under_hair.glsl"

// Skin among roots: share of the light that meets them before the skin, share of what passes through them that goes on
// to it, and share of what the skin sends on that meets them again.
const float kRootShade = 0.65, kRootPasses = 0.6, kRootMeeting = 0.75;

// base: colour without roots, paint and garment, linear. rest: the point in the rest pose, m. cover: 0 bare skin .. 1 among the roots of a hair. garment: m from its edge,
// negative under it. through_hair: see lightUnderHair.
vec3 bodyRadiance(vec3 base, vec3 rest, vec3 world, vec3 normal, float cover, float garment, vec4 through_hair) {
  vec3 to_eye = normalize(eye.xyz - world), n = normalize(normal);
  if (dot(n, to_eye) < 0.0)
    n = normalize(n - 1.02 * dot(n, to_eye) * to_eye);  // interpolated normals may tip over the rim
  float roots = root_color.w * cover;
  vec3 among_roots = 1.0 - kRootShade * roots * (1.0 - kRootPasses * root_color.rgb);
  vec3 albedo = base * mix(vec3(1.0), root_color.rgb, kRootMeeting * roots);
  float roughness = mix(body_color.a, 1.0, roots);
  float pixel = eye.w * length(eye.xyz - world);
  if (paint.x > 0.0) {
    vec3 brow_color = 0.03 + 0.5 * root_color.rgb;
    vec3 head = (rest - face.xyz) * face.w;
    vec4 painted = skinTone(rest, head, pixel) * facePaint(head, brow_color, pixel * face.w);
    albedo *= mix(vec3(1.0), painted.rgb, paint.x);
    roughness *= mix(1.0, painted.w, paint.x);
  }
  float dressed = cloth_color.w - cloth_color.w * smoothstep(-0.5 * pixel, 0.5 * pixel + 1e-4, garment);
  albedo = mix(albedo, cloth_color.rgb * (1.0 - 0.25 * smoothstep(-0.004, -0.002, garment)), dressed);  // a hem
  roughness = mix(roughness, 0.95, dressed);
  vec3 wrap = mix(kSkinWrap, vec3(0.05), dressed);
  float lit = forward.w > 0.0 ? bodyLightOnSurface(world, n, kBodyTaps) : 1.0;
  // The maps know the roots as well, but at a parting the hair leaves sideways and light from above meets none of it:
  // the darker of the two holds, so that no root shades twice.
  vec3 key_light = lit * min(vec3(through_hair.x), among_roots) * key.rgb;
  vec3 open_sky = min(vec3(through_hair.y), among_roots);
  vec3 fill_light = min(vec3(through_hair.z), among_roots) * fill.rgb;
  vec3 rim_light = min(vec3(through_hair.w), among_roots) * rim.rgb;
  vec3 radiance = key_light * wrappedLight(n, to_key.xyz, to_eye, albedo, wrap, roughness);
  radiance += fill_light * wrappedLight(n, to_fill.xyz, to_eye, albedo, wrap, roughness);
  radiance += rim_light * wrappedLight(n, to_rim.xyz, to_eye, albedo, wrap, roughness);
  radiance += open_sky * albedo * mix(ground_light.rgb, sky.rgb, 0.5 + 0.5 * n.y);
  return radiance;
}
