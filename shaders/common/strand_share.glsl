// Painted shares of the look (LookShare): a strand has those of its root, linear between the columns of its face, times
// those of its place from root to tip; of frizz those of its root alone. Without any, shares.x is 0 and all are 1.

struct StrandShare {
  vec4 of;     // width, clump, curl radius, roughness
  vec3 color;  // of the light that passes through pigment
  float frizz;
};

StrandShare shareOfRoot(ivec4 columns, int corners, vec4 blend) {
  StrandShare share = StrandShare(vec4(1.0), vec3(1.0), 1.0);
  if (shares.x == 0) return share;
  share = StrandShare(vec4(0.0), vec3(0.0), 0.0);
  for (int k = 0; k < corners; ++k) {
    int at = shares.x + columns[k] * kShareTexels;
    share.of += blend[k] * texelFetch(layout_texels, at);
    vec4 second = texelFetch(layout_texels, at + 1);
    share.color += blend[k] * second.rgb;
    share.frizz += blend[k] * second.a;
  }
  return share;
}

// Texel `which` of the shares at `along`, 0 root .. 1 tip, and its rate by `along`.
vec4 shareAlong(float along, int which, out vec4 rate) {
  rate = vec4(0.0);
  if (shares.z == 0) return vec4(1.0);
  float at = clamp(along, 0.0, 1.0) * float(shares.z - 1);
  int first = min(int(at), shares.z - 2), texel = shares.y + first * kShareTexels + which;
  vec4 from = texelFetch(layout_texels, texel);
  rate = texelFetch(layout_texels, texel + kShareTexels) - from;
  vec4 share = from + (at - float(first)) * rate;
  rate *= float(shares.z - 1);
  return share;
}

vec4 shareAlong(float along, int which) {
  vec4 rate;
  return shareAlong(along, which, rate);
}
