// Light scattered by a strand towards the eye, evaluated once per ribbon point.
//
// Single scattering: S = sum over R, TT, TRT of M_p N_p / cos^2 theta_d (Marschner et al. 2003). M_p: Gaussians over
// the half angle, shifted by the cuticle; N_p: a table with absorption inside (fiber_scattering.cpp). Multiple
// scattering: dual scattering's idea (Zinke et al. 2008): light that crossed other hairs forward arrives tinted by a_f
// per hair, and light that entered deeper comes back by A_b. The number of hairs crossed is Poisson distributed with
// the optical depth tau, so what arrives unscattered is exp(-tau) and in all exp(-tau (1 - a_f)).

layout(binding = kUnitScattering) uniform sampler2DArray scattering;

const float kScatterDensity = 0.7;  // d_f = d_b of Zinke et al.: hairs are close to each other
const float kBackDeviation = 0.55;  // rad: how far multiple scattering spreads along the strand

float gaussian(float x, float deviation) {
  float scaled = x / deviation;
  return exp(-0.5 * scaled * scaled) / (2.50662827 * deviation);
}

struct Geometry {
  float half_angle;  // theta_h
  float cos_i;       // light's inclination
  float cos_d;       // theta_d
  float phi;         // azimuth between light and eye over pi
};

Geometry scatterGeometry(vec3 tangent, vec3 to_light, vec3 to_eye) {
  float sin_i = clamp(dot(tangent, to_light), -1.0, 1.0), sin_r = clamp(dot(tangent, to_eye), -1.0, 1.0);
  float theta_i = asin(sin_i), theta_r = asin(sin_r);
  vec3 light_across = to_light - sin_i * tangent, eye_across = to_eye - sin_r * tangent;
  float lengths = dot(light_across, light_across) * dot(eye_across, eye_across);
  float cos_phi = lengths > 1e-12 ? dot(light_across, eye_across) * inversesqrt(lengths) : 1.0;
  Geometry g;
  g.half_angle = 0.5 * (theta_i + theta_r);
  g.cos_i = sqrt(max(1.0 - sin_i * sin_i, 0.0));
  g.cos_d = cos(0.5 * (theta_r - theta_i));
  g.phi = acos(clamp(cos_phi, -1.0, 1.0)) * (1.0 / kPi);
  return g;
}

// Radiance per irradiance of the light. tint: colour of this strand's pigment against the mean.
vec3 scatterLight(in Geometry g, float tau, vec3 tint) {
  float shift = lobe_width.w;
  vec2 at = vec2(g.phi * (1.0 - 1.0 / float(kScatterPhi)) + 0.5 / float(kScatterPhi),
                 g.cos_d * (1.0 - 1.0 / float(kScatterTheta)) + 0.5 / float(kScatterTheta));
  vec3 n_r = textureLod(scattering, vec3(at, 0.0), 0.0).rgb, n_tt = textureLod(scattering, vec3(at, 1.0), 0.0).rgb,
       n_trt = textureLod(scattering, vec3(at, 2.0), 0.0).rgb;
  // The half angle moves half as far as the light, hence 0.5: the lobe then integrates to one over the light's
  // inclination.
  float m_r = 0.5 * gaussian(g.half_angle + shift, lobe_width.x),
        m_tt = 0.5 * gaussian(g.half_angle - 0.5 * shift, lobe_width.y),
        m_trt = 0.5 * gaussian(g.half_angle - 1.5 * shift, lobe_width.z);
  float m_back = 0.5 * gaussian(g.half_angle, kBackDeviation);
  vec3 single = gain.x * (m_r * n_r + tint * (m_trt * n_trt)) + tint * (m_tt * n_tt);
  vec3 local = gain.y * tint * local_back.rgb * (2.0 / kPi) * m_back * kScatterDensity;
  vec3 spread = gain.y * tint * (forward_albedo.rgb + backward_albedo.rgb) * (0.5 / kPi) * m_back;
  float direct = exp(-tau);
  vec3 scattered = max(exp(-tau * (1.0 - forward_albedo.rgb)) - direct, 0.0);
  vec3 radiance = direct * (single + local) + kScatterDensity * scattered * (spread + kPi * local);
  return radiance * g.cos_i / max(g.cos_d * g.cos_d, 0.05);
}

// Colour of a strand's pigment against the hair's mean: brighter or darker, a little warmer or cooler, darker at the
// root.
vec3 strandTint(in Strand strand, float along) {
  float brighter = mix(randomOf(strand.key, 20u), randomOf(strand.clump_key, 20u), 0.5) * 2.0 - 1.0;
  float warmer = randomOf(strand.key, 21u) * 2.0 - 1.0;
  vec3 tint = exp2(gain.w * (1.6 * brighter + 0.35 * warmer * vec3(1.0, 0.0, -1.0)));
  return tint * (1.0 - gain.z * (1.0 - smoothstep(0.0, 0.4, along)));
}

vec3 shadeStrand(in Strand strand, in CurvePoint point) {
  vec3 to_eye = normalize(eye.xyz - point.position), tint = strandTint(strand, point.along);
  vec3 tangent = point.tangent;
  float tau_key = 0.5 * (point.light.y + point.light.z), lit = 1.0;
  if (draw.w >= 0) {
    vec3 at = hairShadowCoordinates(draw.w, point.position);
    tau_key = hairOpticalDepth(draw.w, at);
    lit = bodyLightOnHair(draw.w, at);
  }
  vec3 radiance = lit * key.rgb * scatterLight(scatterGeometry(tangent, to_key.xyz, to_eye), tau_key, tint);
  radiance += fill.rgb * scatterLight(scatterGeometry(tangent, to_fill.xyz, to_eye), point.light.y, tint);
  radiance += rim.rgb * scatterLight(scatterGeometry(tangent, to_rim.xyz, to_eye), point.light.z, tint);
  // Ambient: the albedo of a fibre under an even sky; the sky visibility is the mean direct transmittance, raised by what is
  // scattered on.
  vec3 outward = unitOr(point.position - center.xyz, vec3(0.0, 1.0, 0.0));
  vec3 albedo = forward_albedo.rgb + backward_albedo.rgb;
  vec3 around = mix(ground_light.rgb, sky.rgb, 0.5 + 0.5 * outward.y);
  radiance += gain.y * around * tint * albedo * pow(vec3(point.light.x), 1.0 - 0.6 * forward_albedo.rgb);
  return radiance;
}
