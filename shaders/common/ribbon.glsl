// What both strand paths share between curve and raster: which layers a point lies in, its width and its colour.

int lastPoint(in Strand strand) { return int(ceil(strand.end * strand.segments - 1e-4)); }

float strandDither(in Strand strand) { return randomOf(strand.key, 30u); }

// Radius at `along` of the strand, and how much wider than that it must be drawn to be no thinner than the least width.
float strandRadius(in Strand strand, float along) {
  float radius = strand.gain * width.x * mix(1.0, width.y, along * along);
  return shares.x > 0 ? radius * strand.share.of.x * shareAlong(along, 0).x : radius;
}

// The last point whose ribbon can still take a sample (see strand.frag), taken conservatively from the nearest point of
// the hair's ball; -1 when none can. Thin and far away, most strands end here, and nothing of the picture changes by
// it.
int lastShownPoint(in Strand strand, float dither) {
  float nearest = max(dot(ball.xyz - eye.xyz, forward.xyz) - ball.w, 1e-3);
  float needed = (1.0 - dither) / sky.w * (0.5 * width.w * eye.w * nearest) / (strand.gain * width.x);  // share of the root's radius
  if (shares.x > 0) needed /= strand.share.of.x * center.w;
  if (!(needed <= 1.0)) return -1;
  float along = width.y < 1.0 && shares.z == 0 ? sqrt((1.0 - needed) / (1.0 - width.y)) : 1.0;
  return along >= 1.0 ? lastPoint(strand) : int(ceil(along * strand.end * strand.segments));
}

struct RibbonPoint {
  vec3 aside;      // half the ribbon's width, world
  float coverage;  // share of the drawn width that is hair
};

RibbonPoint ribbonPoint(in Strand strand, in CurvePoint point) {
  vec3 to_eye = eye.xyz - point.position;
  float distance_ahead = max(-dot(to_eye, forward.xyz), 1e-3);
  float radius = strandRadius(strand, point.along), least = 0.5 * width.w * eye.w * distance_ahead;
  float drawn = max(radius, least);
  RibbonPoint ribbon;
  ribbon.aside = unitOr(cross(point.tangent, to_eye), vec3(1.0, 0.0, 0.0)) * drawn;
  ribbon.coverage = radius / drawn;
  return ribbon;
}
