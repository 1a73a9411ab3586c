#include "app/figure/mannequin_field.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

// First-order distance to an ellipsoid-like surface: k0 (k0 - 1) / k1 with k0 = |p / r| and k1 = |p / r^2|, which is
// f / |grad f| for f = k0 (k0 - 1) ... exact on the surface to first order (the usual Taubin estimate).
double scaledDistance(const Vec3& p, const Vec3& r) {
  const Vec3 u = p.cwiseQuotient(r);
  const double k0 = u.norm(), k1 = u.cwiseQuotient(r).norm();
  if (k0 < 0.2) return (k0 - 1) * r.minCoeff();
  return k0 * (k0 - 1) / k1;
}

Section mixed(const Section& s, const Section& m, const Section& e, const Section& n, double t) {
  // Cubic Hermite with slopes per unit of t.
  const double h = e.t - s.t, u = std::clamp((t - s.t) / h, 0.0, 1.0);
  const double a = (1 + 2 * u) * (1 - u) * (1 - u), b = u * (1 - u) * (1 - u) * h, c = u * u * (3 - 2 * u),
               d = u * u * (u - 1) * h;
  return {t, a * s.side + b * m.side + c * e.side + d * n.side, a * s.front + b * m.front + c * e.front + d * n.front,
          a * s.back + b * m.back + c * e.back + d * n.back, a * s.shift + b * m.shift + c * e.shift + d * n.shift};
}

}  // namespace

double smoothMin(double a, double b, double k) {
  const double gap = std::abs(a - b);
  if (gap >= k) return std::min(a, b);
  const double h = (k - gap) / k;
  return std::min(a, b) - h * h * h * k / 6;
}

double smoothMax(double a, double b, double k) {
  return -smoothMin(-a, -b, k);
}

Loft makeLoft(const Vec3& a, const Vec3& b, const Vec3& front, std::vector<Section> sections,
              std::array<double, 2> caps) {
  Loft loft;
  loft.a = a;
  loft.length = std::max((b - a).norm(), 1e-3);
  loft.axis = (b - a).norm() > 1e-6 ? Vec3((b - a).normalized()) : Vec3(Vec3::UnitY());
  Vec3 flat = front - loft.axis * loft.axis.dot(front);
  if (flat.norm() < 1e-3) flat = loft.axis.unitOrthogonal();
  loft.front = flat.normalized();
  loft.side = loft.axis.cross(loft.front);
  loft.cap_a = caps[0];
  loft.cap_b = caps[1];
  loft.sections = std::move(sections);
  const auto& s = loft.sections;
  loft.widest = std::max(caps[0], caps[1]);
  for (std::size_t i = 0; i < s.size(); ++i) {
    loft.widest =
        std::max({loft.widest, s[i].side, s[i].front + std::abs(s[i].shift), s[i].back + std::abs(s[i].shift)});
    const Section& p = s[i == 0 ? 0 : i - 1];
    const Section& n = s[std::min(i + 1, s.size() - 1)];
    const double h = std::max(n.t - p.t, 1e-9);
    loft.slopes.push_back(
        {s[i].t, (n.side - p.side) / h, (n.front - p.front) / h, (n.back - p.back) / h, (n.shift - p.shift) / h});
  }
  return loft;
}

double Loft::lowerBound(const Vec3& p) const {
  const Vec3 d = p - a;
  return (d - std::clamp(axis.dot(d), 0.0, length) * axis).norm() - 1.1 * widest;
}

double Loft::value(const Vec3& p) const {
  const Vec3 d = p - a;
  const double z = axis.dot(d), t = std::clamp(z / length, 0.0, 1.0);
  std::size_t i = 0;
  while (i + 2 < sections.size() && sections[i + 1].t <= t) ++i;
  Section s = mixed(sections[i], slopes[i], sections[i + 1], slopes[i + 1], t);
  const double beyond = z < 0 ? z : std::max(z - length, 0.0);
  if (beyond != 0) {
    // The taper goes on into the cap, fading, or a crease would run around the seam.
    const Section& m = z < 0 ? slopes.front() : slopes.back();
    const double u = beyond / length;
    s.side *= std::exp(std::clamp(m.side / s.side * u, -2.0, 1.0));
    s.front *= std::exp(std::clamp(m.front / s.front * u, -2.0, 1.0));
    s.back *= std::exp(std::clamp(m.back / s.back * u, -2.0, 1.0));
    s.shift += m.shift * std::clamp(u, -0.2, 0.2);
  }
  const double y = front.dot(d) - s.shift;
  return scaledDistance(Vec3(side.dot(d), y, beyond), Vec3(s.side, y > 0 ? s.front : s.back, z < 0 ? cap_a : cap_b));
}

double Egg::value(const Vec3& p) const {
  return scaledDistance(axes.transpose() * (p - center), radii);
}

double RoundCone::value(const Vec3& p) const {
  // Radius interpolated along the segment; the sideways shift of the foot point by the slope is left out: cones here
  // are slim.
  const Vec3 ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-12), 0.0, 1.0);
  const double eased = t * t * (3 - 2 * t);
  return (p - a - t * ab).norm() - (ra + (rb - ra) * eased);
}

namespace {

constexpr double kFar = 0.12;  // m: farther than every blend width, so a bound may stand for the distance

// Blends `shape` into d, unless it is too far away to matter.
template <typename Shape>
double joined(double d, const Shape& shape, const Vec3& p, double k) {
  return shape.lowerBound(p) > d + k ? d : smoothMin(d, shape.value(p), k);
}

// Limbs: where all of the limb lies beyond `limit`, some value beyond it.
double armValue(const BodyField::ArmShape& arm, const Vec3& p, double limit) {
  const double upper = arm.upper.lowerBound(p), fore = arm.fore.lowerBound(p);
  const double hand = (p - arm.palm.a).norm() - 0.24 * (arm.upper.length + arm.fore.length) - 0.08;
  const double bound = std::min({upper, fore, hand}) - 0.03;
  if (bound > limit) return bound;
  double d = smoothMin(arm.upper.value(p), arm.fore.value(p), 0.02);
  d = joined(d, arm.deltoid, p, 0.04);
  if (hand > d + 0.02) return d;
  return smoothMin(d, mittenValue(arm, p), 0.02);
}

double legValue(const BodyField::LegShape& leg, const Vec3& p, double limit) {
  const double foot_bound = leg.foot.lowerBound(p) - 0.03;
  const double bound = std::min({leg.thigh.lowerBound(p), leg.shin.lowerBound(p), foot_bound}) - 0.03;
  if (bound > limit) return bound;
  double d = smoothMin(leg.thigh.value(p), leg.shin.value(p), 0.025);
  d = joined(d, leg.knee, p, 0.025);
  if (foot_bound > d + 0.045) return d;
  double foot = smoothMin(leg.foot.value(p), leg.heel.value(p), 0.035);
  foot = smoothMax(foot, leg.sole - p.y(), 0.012);
  return smoothMin(d, foot, 0.045);
}

double trunkValue(const BodyField& body, const Vec3& p) {
  if (const double bound = body.trunk.lowerBound(p); bound > kFar) return bound;
  double d = body.trunk.value(p);
  // Left and right are joined to each other first: blending one after the other would favour one side.
  d = smoothMin(d, smoothMin(body.yokes[0].value(p), body.yokes[1].value(p), 0.03), 0.07);
  for (int m = 0; m < 3; ++m) {
    const Egg &left = body.masses[m], &right = body.masses[m + 3];
    if (std::min(left.lowerBound(p), right.lowerBound(p)) > d + 0.05) continue;
    d = smoothMin(d, smoothMin(left.value(p), right.value(p), 0.02), 0.035);
  }
  return d;
}

double coneChain(const std::vector<RoundCone>& cones, const Vec3& p) {
  double d = 1e3;
  for (const RoundCone& cone : cones) d = joined(d, cone, p, 0.02);
  return d;
}

// The head as metres; a sphere stands for it from afar.
double headDistance(const BodyField& body, const Vec3& p, double limit) {
  const Vec3 q = body.toHead(p);
  const double gap = ((q - Vec3(0, 0.5, 0)).norm() - 0.62) * body.head_scale;
  return gap > limit ? gap : headValue(q) * body.head_scale;
}

}  // namespace

RegionValues BodyField::regions(const Vec3& p) const {
  RegionValues r;
  r.head = headDistance(*this, p, kFar);
  r.neck = neck.value(p);
  r.trunk = trunkValue(*this, p);
  for (int s = 0; s < 2; ++s) {
    r.arms[s] = arms[s].present ? armValue(arms[s], p, kFar) : 1e3;
    r.legs[s] = legs[s].present ? legValue(legs[s], p, kFar) : 1e3;
  }
  for (const auto& cones : appendages) r.appendages.push_back(coneChain(cones, p));
  return r;
}

double BodyField::value(const Vec3& p) const {
  double d = trunkValue(*this, p);
  const double scale = figure.height / 1.7;
  d = joined(d, neck, p, 0.06 * scale);
  // The blend narrows away from the trunk, or the limbs would grow webs to it and to each other. Left and right join
  // each other first, so that neither side is favoured.
  const auto narrowed = [](double along, double start, double range, double wide, double slim) {
    const double t = std::clamp((along - start) / range, 0.0, 1.0);
    return wide + (slim - wide) * t * t * (3 - 2 * t);
  };
  const auto addPair = [&](const auto& limbs, const auto& along, const auto& distance, double wide, double start,
                           double range) {
    double both = 1e3, k = wide * scale;
    for (const auto& limb : limbs)
      if (limb.present) k = std::min(k, scale * narrowed(along(limb), start, range, wide, 0.010));
    for (const auto& limb : limbs)
      if (limb.present) both = smoothMin(both, distance(limb, p, d + k + 0.01), 0.010 * scale);
    d = smoothMin(d, both, k);
  };
  addPair(
      legs, [&](const LegShape& leg) { return leg.thigh.along(p); }, legValue, 0.070, 0.05, 0.25);
  addPair(
      arms, [&](const ArmShape& arm) { return arm.upper.along(p); }, armValue, 0.055, 0.10, 0.30);
  const double k = 0.035 * scale;
  d = smoothMin(d, headDistance(*this, p, d + k), k);
  for (const auto& cones : appendages) d = smoothMin(d, coneChain(cones, p), 0.05 * scale);
  return d;
}

double mittenValue(const BodyField::ArmShape& arm, const Vec3& p) {
  return smoothMin(smoothMin(arm.palm.value(p), arm.fingers.value(p), 0.02), arm.thumb.value(p), 0.018);
}

}  // namespace app
