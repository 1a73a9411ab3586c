// Drawn strands are lifted out of the skin, which ellipsoids stand for, or grids of signed distances where none fit:
// between vertices of the hair mesh, where the simulation holds nothing outside. CPU: render/strands/skin_lift.h.

layout(binding = kUnitSkinGrids) uniform samplerBuffer skin_distances;  // m, grid after grid

// Of a strand's last point: where it would be without skin, and m that it was lifted by.
struct SkinLift {
  vec3 free, by;
  // Between the layers from `layer` on: the skin that the bundle's strands can meet, and that this strand can where it
  // is lifted by no more than kSkinSlack from `around`. Bits of ellipsoids, and from bit kMaxSkin on of grids.
  int layer;
  uvec2 near, met;
  vec3 around;
};

// Before the root.
SkinLift noLift() { return SkinLift(vec3(0.0), vec3(0.0), -1, uvec2(0u), uvec2(0u), vec3(0.0)); }

// Which of `near` a strand can meet between two layers. p0 to p3: the layers' points, of which the curve leads from p1
// to p2. The curve lies within its Bezier points; bends: m that the strand leaves it by at most.
void meetSkin(uvec2 near, int layer, vec3 p0, vec3 p1, vec3 p2, vec3 p3, float bends, inout SkinLift lift) {
  lift.layer = layer;
  lift.near = near;
  lift.met = near;
  lift.around = lift.by;
  vec3 middle = 0.5 * (p1 + p2), after = p1 + (p2 - p0) / 6.0, before = p2 - (p3 - p1) / 6.0;
  float reach = max(0.5 * distance(p1, p2), max(distance(middle, after), distance(middle, before))) + bends +
                kSkinSlack;
  vec4 p = vec4(middle + lift.by, 1.0);
  for (int word = 0; word < 2; ++word)
    for (uint left = near[word]; left != 0u; left &= left - 1u) {
      int bit = findLSB(left), i = 32 * word + bit;
      if (i >= kMaxSkin) break;
      vec4 a = skin_rows[4 * i], b = skin_rows[4 * i + 1], c = skin_rows[4 * i + 2];
      vec3 ball = vec3(dot(a, p), dot(b, p), dot(c, p));
      float steep = sqrt(dot(a.xyz, a.xyz) + dot(b.xyz, b.xyz) + dot(c.xyz, c.xyz));
      if (length(ball) > sqrt(skin_rows[4 * i + 3].w) + reach * steep) lift.met[word] ^= 1u << bit;
    }
}

// The way out of a piece of skin for a point at a gap (m, signed) from it.
struct WayOut {
  float gap, share;    // share: of the way that is taken
  vec3 along, normal;  // normal: shorter where sides meet
};

// False where the point is not lifted out of ellipsoid i: beyond the fourth row's last it never is. In the middle the
// way out turns about. There `back` leads: the way that the strand's point before was lifted, shorter than 1, and the
// shorter the less that one was lifted. line: a unit vector that the way follows, or zero.
bool wayOutOfBall(int i, vec3 point, vec3 back, vec3 line, float blend, out WayOut way) {
  vec4 a = skin_rows[4 * i], b = skin_rows[4 * i + 1], c = skin_rows[4 * i + 2], p = vec4(point, 1.0);
  vec3 ball = vec3(dot(a, p), dot(b, p), dot(c, p));
  float squared = dot(ball, ball);
  if (squared > skin_rows[4 * i + 3].w) return false;
  vec3 from = ball + max(1.0 - squared, 0.0) * skin_rows[4 * i + 3].xyz;
  float off = dot(from, from);
  vec3 out_of = from.x * a.xyz + from.y * b.xyz + from.z * c.xyz;
  vec3 leads = off > 0.0 ? sqrt(off) * normalize(out_of) : vec3(0.0);
  leads += (1.0 - smoothstep(kSkinMiddle, kSkinWhole, off)) * back;
  if (line != vec3(0.0)) leads = line;
  float sure = dot(leads, leads);
  if (sure < kSkinMiddle) return false;
  way.along = leads / sqrt(sure);
  vec3 pace = vec3(dot(a.xyz, way.along), dot(b.xyz, way.along), dot(c.xyz, way.along));
  float along = dot(ball, pace), paces = dot(pace, pace);
  float surface = (sqrt(max(along * along + paces * (1.0 - squared), 0.0)) - along) / paces;
  way.gap = -surface - kSkinGap;
  way.share = smoothstep(kSkinMiddle, kSkinWhole, sure);
  vec3 there = ball + surface * pace;
  way.normal = normalize(there.x * a.xyz + there.y * b.xyz + there.z * c.xyz);
  return way.gap < blend;
}

// The same of grid i: along the distance's slope, whose length tells where sides meet, in the middle of what is thin.
bool wayOutOfGrid(int i, vec3 point, vec3 back, float blend, out WayOut way) {
  vec4 a = skin_grid_rows[3 * i], b = skin_grid_rows[3 * i + 1], c = skin_grid_rows[3 * i + 2], p = vec4(point, 1.0);
  vec3 at = vec3(dot(a, p), dot(b, p), dot(c, p));
  ivec3 nodes = skin_grid_nodes[i].xyz;
  if (!(all(greaterThanEqual(at, vec3(0.0))) && all(lessThan(at, vec3(nodes - 1))))) return false;
  ivec3 cell = ivec3(at);
  vec3 f = at - vec3(cell);
  int row = nodes.x, sheet = row * nodes.y, first = skin_grid_nodes[i].w + cell.x + row * cell.y + sheet * cell.z;
  // Of the four edges along x: values and slopes.
  ivec4 edges = first + ivec4(0, row, sheet, row + sheet);
  vec4 low, rise;
  for (int k = 0; k < 4; ++k) {
    low[k] = texelFetch(skin_distances, edges[k]).x;
    rise[k] = texelFetch(skin_distances, edges[k] + 1).x - low[k];
  }
  vec4 edge = low + f.x * rise;
  float near = edge[0] + f.y * (edge[1] - edge[0]), far = edge[2] + f.y * (edge[3] - edge[2]);
  way.gap = near + f.z * (far - near) - kSkinGap;
  if (way.gap >= blend - kSkinLeft) return false;
  float slope_near = rise[0] + f.y * (rise[1] - rise[0]), slope_far = rise[2] + f.y * (rise[3] - rise[2]);
  float across = edge[1] - edge[0];
  vec3 steps = vec3(slope_near + f.z * (slope_far - slope_near), across + f.z * (edge[3] - edge[2] - across), far - near);
  vec3 slope = steps.x * a.xyz + steps.y * b.xyz + steps.z * c.xyz;
  float steep = dot(slope, slope);
  float clear = smoothstep(kSkinMiddle, kSkinWhole, steep);
  vec3 leads = slope + (1.0 - clear) * back;
  float sure = dot(leads, leads);
  if (sure < kSkinMiddle) return false;
  way.share = smoothstep(kSkinMiddle, kSkinWhole, sure);
  way.along = leads / sqrt(sure);
  way.normal = clear / sqrt(max(steep, kSkinMiddle)) * slope;
  return true;
}

// A point at a gap (m, signed) from an ellipsoid is moved along its normal to the gap f(gap): kSkinGap below
// -kSkinBlend, the gap itself above kSkinBlend, both counted from kSkinGap, and a parabola between. f rises with a
// continuous slope, so that a strand keeps its bends round and none pops up as hair or body moves.
//
// The way out is the surface's normal near the surface and turns, the deeper the point, to the side from which hair
// comes (the fourth row): of a lock that hangs on both sides of a shoulder all strands go over it, none through. Where
// that way turns about, on the other side, it leads to where the point before was lifted, and out of a thin grid else
// back along the strand. The gap is exact, to where the way meets the surface, in the ellipsoid's own measure. s: curve
// parameter, in layers; the first layer leads from the root, which stays, to full lift; by grids the root is lifted as
// well, for between the corners of a face of roots a box bulges. Further rounds, without the parabola, take up what one
// ellipsoid pushes into another: none pushes twice running; a grid may, for its distances are not exact. Where three
// meet, they may push a point round for ever: after kSkinTurns rounds every ellipsoid is left along one line, the mean of
// the last round's ways.
//
// A strand keeps its side: each point begins where the one before it was lifted, and returns with the hair's length.
// So the tip of a strand that lies over a shoulder does not end in it, or below it.
//
// The skin is what meetSkin() has found for the layers at hand.
void leaveSkin(float s, inout SkinLift lift, inout vec3 position, inout vec3 tangent) {
  vec3 free = position;
  uvec2 near = lift.near;
  if (near == uvec2(0u) && lift.by == vec3(0.0)) {
    lift.free = free;
    return;
  }
  lift.by *= exp(-distance(free, lift.free) / kSkinReturn);
  vec3 back = lift.by / (length(lift.by) + kSkinBack), back_in_grid = back - (1.0 - length(back)) * tangent;
  position += lift.by;
  tangent -= lift.by / kSkinReturn;
  vec3 lifted = position, turned = tangent;
  vec3 by_grids = vec3(0.0), together = vec3(0.0), line = vec3(0.0);
  uvec2 among = distance(lift.by, lift.around) > kSkinSlack ? near : lift.met;
  bool moved = among != uvec2(0u);
  int last = -1;
  for (int round = 0; round < kSkinRounds && moved; ++round) {
    moved = false;
    float blend = round == 0 ? kSkinBlend : 0.0;
    if (round == kSkinTurns && dot(together, together) > kSkinMiddle) line = normalize(together);
    together = vec3(0.0);
    for (int word = 0; word < 2; ++word)
      for (uint left = among[word]; left != 0u; left &= left - 1u) {
        int bit = findLSB(left), i = 32 * word + bit;
        bool grid = i >= kMaxSkin;
        WayOut way;
        if (i == last) continue;
        if (grid) {
          if (!wayOutOfGrid(i - kMaxSkin, lifted, back_in_grid, blend, way)) continue;
        } else {
          if (!wayOutOfBall(i, lifted, back, line, blend, way)) continue;
        }
        float bent = max(way.gap + blend, 0.0) / (2.0 * kSkinBlend);
        vec3 by = way.share * (kSkinBlend * bent * bent - way.gap) * way.along;
        lifted += by;
        if (grid) by_grids += by;
        together += way.along;
        turned += way.share * (bent - 1.0) * dot(way.normal, turned) * way.normal;
        moved = true;
        last = grid ? -1 : i;
        if (among != near && distance(lifted - free, lift.around) > kSkinSlack) {
          among = near;
          left = near[word] & ~((1u << bit) - 1u);
        }
      }
  }
  float root = smoothstep(0.0, 1.0, s);
  position = mix(position, lifted, root) + (1.0 - root) * by_grids;
  tangent = mix(tangent, turned, root);
  lift.free = free;
  lift.by = position - free;
}
