// Light scattered by a strand towards the eye, evaluated once per ribbon point.
//
// Single scattering: S = sum over R, TT, TRT of M_p N_p, energy-conserving at every roughness (longitudinal_lobes.h,
// azimuthal_lobes.h). Light of several fibres: radiative transfer in a slab lit along the light's direction, by the
// optical depths in front of the point and behind it (hair_volume.h). A lone strand has neither, a strand on a thick lock
// has all that the lock sends back.

layout(binding = kUnitScattering) uniform sampler2DArray scattering;

// The eye's side of a strand's point, the same for all lights.
struct EyeSide {
  vec3 tangent;
  vec3 across;  // the eye's direction without its part along the strand
  float sine, theta;
  vec4 norm;  // a of R, TT, TRT times c; a of light of several fibres
  float rough;  // share of the lobes' deviations
};

// The light's and the eye's.
struct Geometry {
  float half_angle;        // theta_h
  float cos_i;             // light's inclination
  float cos_product;       // of both inclinations
  float cos_d;             // theta_d
  float cos_phi;           // azimuth between light and eye
  float rough;             // share of the lobes' deviations
  vec4 norm;
};

vec4 inclinationTexel(float theta, int row) {
  float at = (theta / kPi + 0.5) * float(kScatterPhi - 1) + 0.5;
  return textureLod(scattering, vec3(at / float(kScatterPhi), (float(row) + 0.5) / float(kScatterTheta), 3.0), 0.0);
}

// rough: share of the lobes' deviations. A narrower lobe is higher by a fit to the energy of the table's lobes: from 0.2
// to 2 times their deviations they send on the same light within 2 %, in the mean over inclinations.
EyeSide eyeSide(vec3 tangent, vec3 to_eye, float rough) {
  EyeSide side;
  side.rough = rough;
  side.tangent = tangent;
  side.sine = clamp(dot(tangent, to_eye), -1.0, 1.0);
  side.theta = asin(side.sine);
  side.across = to_eye - side.sine * tangent;
  side.norm = inclinationTexel(side.theta, 0);
  side.norm.xyz *= inclinationTexel(side.theta, kScatterTheta - 1).x;
  if (shares.x > 0) {
    vec3 square = 6.4 * lobe_width.xyz * lobe_width.xyz;
    side.norm.xyz *= (1.0 + rough * rough * square) / (rough * (1.0 + square));
  }
  return side;
}

Geometry scatterGeometry(in EyeSide side, vec3 to_light) {
  float sin_i = clamp(dot(side.tangent, to_light), -1.0, 1.0), theta_i = asin(sin_i);
  vec3 light_across = to_light - sin_i * side.tangent;
  float eye_squared = dot(side.across, side.across), lengths = dot(light_across, light_across) * eye_squared;
  Geometry g;
  g.half_angle = 0.5 * (theta_i + side.theta);
  g.cos_i = sqrt(max(1.0 - sin_i * sin_i, 0.0));
  g.cos_product = g.cos_i * sqrt(eye_squared);
  g.cos_d = cos(0.5 * (side.theta - theta_i));
  g.cos_phi = lengths > 1e-12 ? clamp(dot(light_across, side.across) * inversesqrt(lengths), -1.0, 1.0) : 1.0;
  g.norm = side.norm * inclinationTexel(theta_i, 0);
  g.rough = side.rough;
  return g;
}

// See longitudinalShape of longitudinal_lobes.h.
float longitudinalShape(float half_angle, float cos_product, float deviation) {
  float v = 4.0 * deviation * deviation, sine = sin(half_angle);
  return exp(-2.0 * sine * sine / v) / (cos_product + kGrazing * v);
}

// Light that several fibres scattered, by the optical depths in front of the point (x) and behind it (y).
vec3 volumeLight(float cos_phi, vec2 tau) {
  vec2 at = min(tau / (tau + kVolumeDepth) * float(kVolumeSteps), vec2(float(kVolumeSteps - 1))) + 0.5;
  const vec2 kTexel = 1.0 / vec2(float(kScatterPhi), float(kScatterTheta));
  vec2 block = vec2(float(kVolumeSteps), 0.0);
  vec3 even = textureLod(scattering, vec3(at * kTexel, 4.0), 0.0).rgb;
  vec3 once = textureLod(scattering, vec3((at + block) * kTexel, 4.0), 0.0).rgb;
  vec3 twice = textureLod(scattering, vec3((at + 2.0 * block) * kTexel, 4.0), 0.0).rgb;
  return max(even + cos_phi * (once + cos_phi * twice), 0.0);
}

// Radiance per irradiance of the light. tau: optical depth in front of the point and behind it. tint: colour of this
// strand's pigment against the mean.
vec3 scatterLight(in Geometry g, vec2 tau, vec3 tint) {
  float shift = lobe_width.w * g.cos_d;
  vec2 at = vec2(acos(g.cos_phi) / kPi * (1.0 - 1.0 / float(kScatterPhi)) + 0.5 / float(kScatterPhi),
                 g.cos_d * (1.0 - 1.0 / float(kScatterTheta)) + 0.5 / float(kScatterTheta));
  vec3 n_r = textureLod(scattering, vec3(at, 0.0), 0.0).rgb, n_tt = textureLod(scattering, vec3(at, 1.0), 0.0).rgb,
       n_trt = textureLod(scattering, vec3(at, 2.0), 0.0).rgb;
  vec3 deviation = g.rough * lobe_width.xyz;
  vec3 m = g.norm.xyz * vec3(longitudinalShape(g.half_angle + shift, g.cos_product, deviation.x),
                             longitudinalShape(g.half_angle - 0.5 * shift, g.cos_product, deviation.y),
                             longitudinalShape(g.half_angle - 1.5 * shift, g.cos_product, deviation.z));
  vec3 single = m.x * n_r + tint * (m.y * n_tt + m.z * n_trt);
  float m_volume = g.norm.w * longitudinalShape(g.half_angle, g.cos_product, kVolumeSpread);
  return g.cos_i * (exp(-tau.x) * single + gain.y * m_volume * tint * volumeLight(g.cos_phi, tau));
}

// Colour of a strand's pigment against the hair's mean: brighter or darker, a little warmer or cooler, darker at the
// root; never so bright that a fibre sends on more than it gets.
vec3 strandTint(in Strand strand, float along) {
  float brighter = mix(randomOf(strand.key, 20u), randomOf(strand.clump_key, 20u), 0.5) * 2.0 - 1.0;
  float warmer = randomOf(strand.key, 21u) * 2.0 - 1.0;
  vec3 tint = exp2(gain.w * (1.6 * brighter + 0.35 * warmer * vec3(1.0, 0.0, -1.0)));
  tint *= 1.0 - gain.z * (1.0 - smoothstep(0.0, 0.4, along));
  if (shares.x > 0) tint *= strand.share.color * shareAlong(along, 1).rgb;
  return min(tint, 1.0 / max(forward_albedo.rgb + backward_albedo.rgb, 1e-3));
}

// Share of the optical depth towards a light that counts. Drawn strands cover less than the hairs that they stand for: the
// eye sees deeper in, which on the light's side is as much farther from the light. From the other side it is nearer.
float seenShare(vec3 to_eye, vec3 to_light) {
  return mix(1.0, gain.x, smoothstep(-0.5, 0.5, dot(to_eye, to_light)));
}

vec3 shadeStrand(in Strand strand, in CurvePoint point) {
  vec3 to_eye = normalize(eye.xyz - point.position), tint = strandTint(strand, point.along);
  float rough = shares.x > 0 ? strand.share.of.w * shareAlong(point.along, 0).w : 1.0;
  vec3 outward = unitOr(point.position - center.xyz, vec3(0.0, 1.0, 0.0));
  // Scales and bends too small to be drawn tilt each strand's highlights, those of a clump alike.
  float tilt = variation.y * (1.2 * randomOf(strand.key, 34u) + 0.8 * randomOf(strand.clump_key, 34u) - 1.0);
  vec3 tangent = point.tangent + tilt * (outward - point.tangent * dot(outward, point.tangent));
  EyeSide side = eyeSide(unitOr(tangent, point.tangent), to_eye, rough);
  vec2 tau_fill = vec2(point.light.y, point.behind.x), tau_rim = vec2(point.light.z, point.behind.y);
  vec2 tau_key = 0.5 * (tau_fill + tau_rim);
  float lit = 1.0;
  if (draw.w >= 0) {
    vec3 at = hairShadowCoordinates(draw.w, point.position);
    tau_key = hairOpticalDepths(draw.w, at);
    lit = bodyLightOnHair(draw.w, at);
  }
  tau_key.x *= seenShare(to_eye, to_key.xyz);
  tau_fill.x *= kSoftDepth;
  tau_rim.x *= kSoftDepth;
  vec3 radiance = lit * key.rgb * scatterLight(scatterGeometry(side, to_key.xyz), tau_key, tint);
  radiance += fill.rgb * scatterLight(scatterGeometry(side, to_fill.xyz), tau_fill, tint);
  radiance += rim.rgb * scatterLight(scatterGeometry(side, to_rim.xyz), tau_rim, tint);
  // Ambient: the albedo of a fibre under an even sky; the sky visibility is the mean direct transmittance, raised by what is
  // scattered on.
  vec3 albedo = forward_albedo.rgb + backward_albedo.rgb;
  vec3 around = mix(ground_light.rgb, sky.rgb, 0.5 + 0.5 * outward.y);
  float open = max(point.light.x, 0.0);  // rounded, a blend of nothing may lie below it
  radiance += gain.y * around * tint * albedo * pow(vec3(open), kSoftDepth * (1.0 - 0.6 * forward_albedo.rgb));
  return radiance;
}
