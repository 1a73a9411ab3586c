// Drawn strands are lifted out of the skin, which ellipsoids stand for: between vertices of the hair mesh, where the
// simulation holds nothing outside. CPU: render/strands/skin_lift.h.

// Of a strand's last point: where it would be without skin, and m that it was lifted by. Zero before the root.
struct SkinLift {
  vec3 free, by;
};

// A point at a gap (m, signed) from an ellipsoid is moved along its normal to the gap f(gap): kSkinGap below
// -kSkinBlend, the gap itself above kSkinBlend, both counted from kSkinGap, and a parabola between. f rises with a
// continuous slope, so that a strand keeps its bends round and none pops up as hair or body moves.
//
// The way out is the surface's normal near the surface and turns, the deeper the point, to the side from which hair
// comes (the fourth row): of a lock that hangs on both sides of a shoulder all strands go over it, none through. Where
// that way turns about, on the other side, nothing is lifted. The gap is exact, to where the way meets the surface, in
// the ellipsoid's own measure. s: curve parameter, in layers; the first layer leads from the root, which stays, to full
// lift. Further rounds, without the parabola, take up what one ellipsoid pushes into another: none pushes twice running.
//
// A strand keeps its side: each point begins where the one before it was lifted, and returns with the hair's length.
// So the tip of a strand that lies over a shoulder does not end in it, or below it.
//
// near: a bit for each ellipsoid that the strand can meet between its two layers (render/hair/skin_reach.h).
void leaveSkin(uvec2 near, float s, inout SkinLift lift, inout vec3 position, inout vec3 tangent) {
  vec3 free = position;
  if (near == uvec2(0u) && lift.by == vec3(0.0)) {
    lift.free = free;
    return;
  }
  lift.by *= exp(-distance(free, lift.free) / kSkinReturn);
  position += lift.by;
  tangent -= lift.by / kSkinReturn;
  vec3 lifted = position, turned = tangent;
  bool moved = near != uvec2(0u);
  int last = -1;
  for (int round = 0; round < kSkinRounds && moved; ++round) {
    moved = false;
    float blend = round == 0 ? kSkinBlend : 0.0;
    for (int word = 0; word < 2; ++word)
      for (uint left = word == 0 ? near.x : near.y; left != 0u; left &= left - 1u) {
        int i = 32 * word + findLSB(left);
        if (i == last) continue;
        vec4 a = skin_rows[4 * i], b = skin_rows[4 * i + 1], c = skin_rows[4 * i + 2], p = vec4(lifted, 1.0);
        vec3 ball = vec3(dot(a, p), dot(b, p), dot(c, p));
        float squared = dot(ball, ball);
        if (squared > kSkinFar) continue;
        vec3 from = ball + max(1.0 - squared, 0.0) * skin_rows[4 * i + 3].xyz;
        float off = dot(from, from);
        if (off < kSkinMiddle) continue;
        vec3 out_of = normalize(from.x * a.xyz + from.y * b.xyz + from.z * c.xyz);
        vec3 pace = vec3(dot(a.xyz, out_of), dot(b.xyz, out_of), dot(c.xyz, out_of));
        float along = dot(ball, pace), paces = dot(pace, pace);
        float surface = (sqrt(max(along * along + paces * (1.0 - squared), 0.0)) - along) / paces;
        float gap = -surface - kSkinGap;
        if (gap >= blend) continue;
        float share = smoothstep(kSkinMiddle, kSkinWhole, off), bent = max(gap + blend, 0.0) / (2.0 * kSkinBlend);
        vec3 there = ball + surface * pace, normal = normalize(there.x * a.xyz + there.y * b.xyz + there.z * c.xyz);
        lifted += share * (kSkinBlend * bent * bent - gap) * out_of;
        turned += share * (bent - 1.0) * dot(normal, turned) * normal;
        moved = true;
        last = i;
      }
  }
  float root = smoothstep(0.0, 1.0, s);
  position = mix(position, lifted, root);
  tangent = mix(tangent, turned, root);
  lift = SkinLift(free, position - free);
}
