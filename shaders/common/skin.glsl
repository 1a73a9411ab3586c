// Drawn strands are lifted out of the skin, which ellipsoids stand for: between vertices of the hair mesh, where the
// simulation holds nothing outside. CPU: render/strands/skin_lift.h.

// A point at a gap (m, signed) from an ellipsoid is moved along its normal to the gap f(gap): kSkinGap below
// -kSkinBlend, the gap itself above kSkinBlend, both counted from kSkinGap, and a parabola between. f rises with a
// continuous slope, so that a strand keeps its bends round and none pops up as hair or body moves. Near the middle of
// an ellipsoid, where the way out turns about, nothing is lifted. s: curve parameter, in layers; the first layer leads
// from the root, which stays, to full lift. Gap and normal are of first order (gradient of the distance to the middle
// in the ellipsoid's own measure); the second round takes up what that leaves, and what one ellipsoid pushes into
// another.
//
// near: a bit for each ellipsoid that the strand can meet between its two layers (render/hair/skin_reach.h).
void leaveSkin(uvec2 near, float s, inout vec3 position, inout vec3 tangent) {
  float root = smoothstep(0.0, 1.0, s);
  bool moved = near != uvec2(0u);
  for (int round = 0; round < 2 && moved; ++round) {
    moved = false;
    for (int word = 0; word < 2; ++word)
      for (uint left = word == 0 ? near.x : near.y; left != 0u; left &= left - 1u) {
        int i = 32 * word + findLSB(left);
        vec4 a = skin_rows[3 * i], b = skin_rows[3 * i + 1], c = skin_rows[3 * i + 2], p = vec4(position, 1.0);
        vec3 ball = vec3(dot(a, p), dot(b, p), dot(c, p));
        float squared = dot(ball, ball);
        if (squared > kSkinFar || squared < kSkinMiddle) continue;
        vec3 slope = ball.x * a.xyz + ball.y * b.xyz + ball.z * c.xyz;
        float far = sqrt(squared), steep = length(slope);
        float gap = far * (far - 1.0) / steep - kSkinGap;
        if (gap >= kSkinBlend) continue;
        float x = max(gap + kSkinBlend, 0.0), share = root * smoothstep(kSkinMiddle, kSkinWhole, squared);
        vec3 normal = slope / steep;
        position += share * (x * x / (4.0 * kSkinBlend) - gap) * normal;
        tangent += share * (x / (2.0 * kSkinBlend) - 1.0) * dot(normal, tangent) * normal;
        moved = true;
      }
  }
}
