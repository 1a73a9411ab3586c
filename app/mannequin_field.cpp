#include "app/mannequin_field.h"

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
  double widest = 0;
  for (std::size_t i = 0; i < s.size(); ++i) {
    widest = std::max({widest, s[i].side, s[i].front + std::abs(s[i].shift), s[i].back + std::abs(s[i].shift)});
    const Section& p = s[i == 0 ? 0 : i - 1];
    const Section& n = s[std::min(i + 1, s.size() - 1)];
    const double h = std::max(n.t - p.t, 1e-9);
    loft.slopes.push_back(
        {s[i].t, (n.side - p.side) / h, (n.front - p.front) / h, (n.back - p.back) / h, (n.shift - p.shift) / h});
  }
  loft.middle = a + 0.5 * loft.length * loft.axis;
  loft.reach = 0.5 * loft.length + std::max(caps[0], caps[1]) + widest;
  return loft;
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

double sphereGap(const Vec3& p, const Loft& loft) {
  return (p - loft.middle).norm() - loft.reach;
}

constexpr double kFar = 0.12;  // m: farther than every blend width, so a bound may stand for the distance

double armValue(const BodyField::ArmShape& arm, const Vec3& p) {
  const Vec3 middle = arm.fore.a;
  const double reach = std::max(arm.upper.length, arm.fore.length + arm.palm.length + arm.fingers.length) + 0.12;
  if (const double gap = (p - middle).norm() - reach; gap > kFar) return gap;
  double d = smoothMin(arm.upper.value(p), arm.fore.value(p), 0.02);
  d = smoothMin(d, arm.deltoid.value(p), 0.04);
  double hand = smoothMin(arm.palm.value(p), arm.fingers.value(p), 0.02);
  hand = smoothMin(hand, arm.thumb.value(p), 0.018);
  return smoothMin(d, hand, 0.02);
}

double legValue(const BodyField::LegShape& leg, const Vec3& p) {
  const Vec3 middle = leg.shin.a;
  const double reach = std::max(leg.thigh.length, leg.shin.length) + 0.25;
  if (const double gap = (p - middle).norm() - reach; gap > kFar) return gap;
  double d = smoothMin(leg.thigh.value(p), leg.shin.value(p), 0.025);
  d = smoothMin(d, leg.knee.value(p), 0.025);
  double foot = smoothMin(leg.foot.value(p), leg.heel.value(p), 0.035);
  foot = smoothMax(foot, leg.sole - p.y(), 0.012);
  return smoothMin(d, foot, 0.045);
}

double trunkValue(const BodyField& body, const Vec3& p) {
  if (const double gap = sphereGap(p, body.trunk); gap > kFar) return gap;
  double d = body.trunk.value(p);
  for (const RoundCone& yoke : body.yokes) d = smoothMin(d, yoke.value(p), 0.07);
  for (const Egg& mass : body.masses) d = smoothMin(d, mass.value(p), 0.035);
  return d;
}

double coneChain(const std::vector<RoundCone>& cones, const Vec3& p) {
  double d = 1e3;
  for (const RoundCone& cone : cones) d = smoothMin(d, cone.value(p), 0.02);
  return d;
}

// The head as metres; a sphere stands for it from afar.
double headDistance(const BodyField& body, const Vec3& p) {
  const Vec3 q = body.toHead(p);
  const double gap = ((q - Vec3(0, 0.5, 0)).norm() - 0.75) * body.head_scale;
  return gap > kFar ? gap : headValue(q) * body.head_scale;
}

}  // namespace

RegionValues BodyField::regions(const Vec3& p) const {
  RegionValues r;
  r.head = headDistance(*this, p);
  r.neck = neck.value(p);
  r.trunk = trunkValue(*this, p);
  for (int s = 0; s < 2; ++s) {
    r.arms[s] = arms[s].present ? armValue(arms[s], p) : 1e3;
    r.legs[s] = legs[s].present ? legValue(legs[s], p) : 1e3;
  }
  for (const auto& cones : appendages) r.appendages.push_back(coneChain(cones, p));
  return r;
}

double BodyField::value(const Vec3& p) const {
  double d = trunkValue(*this, p);
  const double scale = figure.height / 1.7;
  if (const double gap = sphereGap(p, neck); gap < kFar) d = smoothMin(d, neck.value(p), 0.06 * scale);
  for (int s = 0; s < 2; ++s) {
    // The blend narrows away from the trunk, or the limbs would grow webs to it and to each other.
    if (legs[s].present) {
      const double t = std::clamp((legs[s].thigh.along(p) - 0.05) / 0.25, 0.0, 1.0);
      d = smoothMin(d, legValue(legs[s], p), scale * (0.07 - 0.058 * t * t * (3 - 2 * t)));
    }
    if (arms[s].present) {
      const double t = std::clamp((arms[s].upper.along(p) - 0.10) / 0.30, 0.0, 1.0);
      d = smoothMin(d, armValue(arms[s], p), scale * (0.055 - 0.047 * t * t * (3 - 2 * t)));
    }
  }
  d = smoothMin(d, headDistance(*this, p), 0.035 * scale);
  for (const auto& cones : appendages) d = smoothMin(d, coneChain(cones, p), 0.05 * scale);
  return d;
}

}  // namespace app
