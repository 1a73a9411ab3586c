#include "app/figure/mannequin_parts.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "app/figure/mannequin_figure.h"
#include "app/motion/least_rotation.h"

namespace app {

namespace {

BodyEllipsoid ellipsoidAt(const Vec3& center, const Eigen::Quaterniond& rotation, const Vec3& radii) {
  BodyEllipsoid e;
  e.center = center;
  e.rotation = rotation;
  e.radii = radii;
  return e;
}

// Long axis (y of the ellipsoid) from a to b.
BodyEllipsoid ellipsoidAlong(const Vec3& a, const Vec3& b, double side, double overlap) {
  return ellipsoidAt(0.5 * (a + b), leastRotation(Vec3::UnitY(), b - a),
                     Vec3(side, 0.5 * (b - a).norm() + overlap, side));
}

double nearest(const RegionValues& r) {
  double d = std::min({r.head, r.neck, r.trunk, r.arms[0], r.arms[1], r.legs[0], r.legs[1]});
  for (const double a : r.appendages) d = std::min(d, a);
  return d;
}

struct Sorter {
  const Mannequin& m;
  std::vector<FitPoint> points;
  std::vector<RegionValues> regions;
  double s;
  std::vector<BodyPart> parts;

  explicit Sorter(const Mannequin& mannequin) : m(mannequin), s(mannequin.field.figure.height / 1.70) {
    points = surfacePoints(m.mesh);
    for (const FitPoint& p : points) regions.push_back(m.field.regions(p.position));
  }

  // The spine joint that moves the trunk at a height.
  int spineJoint(double y) const {
    int joint = m.roles.spine.front();
    for (int j : m.roles.spine)
      if (j != m.roles.head && m.skeleton.joints[j].rest_world.translation().y() <= y + 0.01 * s) joint = j;
    return joint;
  }

  void add(const std::string& name, int joint, const BodyEllipsoid& start, double hold,
           const std::function<bool(const Vec3&, const RegionValues&)>& belongs) {
    BodyPart part;
    part.name = name;
    part.joint = joint;
    part.given_start = true;
    part.start = start;
    part.hold = hold;
    for (std::size_t v = 0; v < points.size(); ++v)
      if (belongs(points[v].position, regions[v])) part.points.push_back(points[v]);
    parts.push_back(std::move(part));
  }

  void addHead() {
    const BodyField& body = m.field;
    const auto fromHead = [&](const Vec3& q) { return Vec3(body.head_origin + body.head_scale * q); };
    const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
    add("head", m.roles.head,
        ellipsoidAt(fromHead({0, 0.62, -0.045}), level, body.head_scale * Vec3(0.33, 0.375, 0.415)), 0.05,
        [&](const Vec3& p, const RegionValues& r) {
          const Vec3 q = body.toHead(p);
          const bool ear = std::abs(q.x()) > 0.26 && q.y() < 0.62 && std::abs(q.z() + 0.035) < 0.14;
          const bool face = q.y() < 0.60 && q.z() > 0.12;
          return q.y() > 0.36 && !ear && !face && r.head < r.neck;
        });
    add("jaw", m.roles.head, ellipsoidAt(fromHead({0, 0.30, 0.13}), level, body.head_scale * Vec3(0.24, 0.33, 0.25)),
        0.04, [&](const Vec3& p, const RegionValues& r) {
          const Vec3 q = body.toHead(p);
          const bool nose = q.z() > 0.385 && q.y() > 0.30;
          return q.y() < 0.56 && q.z() > -0.02 && std::abs(q.x()) < 0.30 && !nose && r.head < r.neck;
        });
    add("chin", m.roles.head, ellipsoidAt(fromHead({0, 0.17, 0.17}), level, body.head_scale * Vec3(0.19, 0.16, 0.18)),
        0.02, [&](const Vec3& p, const RegionValues& r) {
          const Vec3 q = body.toHead(p);
          return q.y() > -0.03 && q.y() < 0.28 && q.z() > 0.02 && r.head < r.neck;
        });
    const int neck =
        m.roles.head_is_neck || m.roles.spine.size() < 2 ? m.roles.head : m.roles.spine[m.roles.spine.size() - 2];
    const Loft& loft = body.neck;
    add("neck", neck, ellipsoidAlong(loft.a, loft.a + loft.axis * loft.length, 0.052 * s, 0.035 * s), 0.02,
        [&](const Vec3& p, const RegionValues& r) {
          const double t = loft.along(p);
          return r.neck < r.head && r.neck < r.trunk && t > 0.05 && t < 1.0;
        });
  }

  void addTrunk() {
    const Figure& f = m.field.figure;
    const double span = f.shoulder_level - f.pelvis.y();
    const auto level = [&](double t) {
      return Vec3((1 - t) * f.pelvis.x() + t * f.neck_base.x(), f.pelvis.y() + t * span,
                  (1 - t) * f.pelvis.z() + t * f.neck_base.z());
    };
    const auto slice = [&](const std::string& name, double low, double high, const Vec3& radii, double hold) {
      const double middle = 0.5 * (low + high);
      add(name, spineJoint(level(middle).y()), ellipsoidAt(level(middle), Eigen::Quaterniond::Identity(), s * radii),
          hold, [&, low, high](const Vec3& p, const RegionValues& r) {
            const double t = (p.y() - f.pelvis.y()) / span;
            return t > low && t < high && r.trunk <= nearest(r);
          });
    };
    slice("pelvis", -0.08, 0.24, {0.165, 0.13, 0.11}, 0.04);
    slice("waist", 0.18, 0.50, {0.125, 0.15, 0.082}, 0.03);
    slice("chest", 0.46, 0.80, {0.135, 0.15, 0.095}, 0.03);
    slice("upper_chest", 0.74, 1.00, {0.135, 0.12, 0.085}, 0.03);
    slice("neck_base", 0.94, 1.25, {0.085, 0.07, 0.062}, 0.03);
    const int chest = spineJoint(level(0.8).y());
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1 : -1;
      const std::string prefix = side == 0 ? "left_" : "right_";
      const Egg& bust = m.field.masses[3 * side];
      add(prefix + "bust", chest, ellipsoidAt(bust.center, Eigen::Quaterniond(bust.axes), bust.radii), 0.012,
          [&, sign](const Vec3& p, const RegionValues& r) {
            return sign * p.x() > 0 && bust.value(p) < 0.006 && r.trunk < std::min(r.arms[0], r.arms[1]);
          });
      const Egg& blade = m.field.masses[3 * side + 1];
      add(prefix + "shoulder_blade", chest, ellipsoidAt(blade.center, Eigen::Quaterniond(blade.axes), blade.radii),
          0.02, [&, sign](const Vec3& p, const RegionValues& r) {
            return sign * p.x() > 0.01 && blade.value(p) < 0.012 && p.z() < blade.center.z() &&
                   r.trunk < std::min(r.arms[0], r.arms[1]);
          });
      const RoundCone& yoke = m.field.yokes[side];
      const int clavicle = m.roles.arms[side].clavicle;
      add(prefix + "shoulder", clavicle >= 0 ? clavicle : chest, ellipsoidAlong(yoke.a, yoke.b, 0.046 * s, 0.045 * s),
          0.015, [&, sign](const Vec3& p, const RegionValues& r) {
            const double across = sign * (p.x() - f.neck_base.x());
            return across > 0.035 * s && across < f.shoulder_half + 0.02 * s && p.y() > f.shoulder_level - 0.02 * s &&
                   yoke.value(p) < 0.02 && r.trunk < r.neck + 0.01;
          });
    }
  }

  void addArm(int side) {
    const BodyField::ArmShape& arm = m.field.arms[side];
    const ArmRoles& roles = m.roles.arms[side];
    const std::string prefix = side == 0 ? "left_" : "right_";
    const auto near = [side](const RegionValues& r) { return r.arms[side] <= nearest(r); };
    add(prefix + "deltoid", roles.upper,
        ellipsoidAt(arm.deltoid.center, Eigen::Quaterniond(arm.deltoid.axes), arm.deltoid.radii), 0.015,
        [&, near](const Vec3& p, const RegionValues& r) { return near(r) && arm.deltoid.value(p) < 0.008; });
    parts.back().outside = 4;
    const auto end = [](const Loft& l) { return Vec3(l.a + l.axis * l.length); };
    add(prefix + "upper_arm", roles.upper, ellipsoidAlong(arm.upper.a, end(arm.upper), 0.041 * s, 0.06 * s), 0.02,
        [&, near](const Vec3& p, const RegionValues& r) {
          const double t = arm.upper.along(p);
          return near(r) && t > 0.15 && arm.fore.along(p) < 0.05;
        });
    add(prefix + "forearm", roles.fore, ellipsoidAlong(arm.fore.a, end(arm.fore), 0.033 * s, 0.05 * s), 0.02,
        [&, near](const Vec3& p, const RegionValues& r) {
          const double t = arm.fore.along(p);
          return near(r) && t > 0 && t < 1;
        });
    const int hand = roles.hand >= 0 ? roles.hand : roles.fore;
    add(prefix + "hand", hand, ellipsoidAlong(arm.palm.a, end(arm.fingers), 0.028 * s, 0.02 * s), 0.03,
        [&, near](const Vec3& p, const RegionValues& r) {
          return near(r) && arm.fore.along(p) > 1 && arm.thumb.value(p) > 0.004;
        });
  }

  void addLeg(int side) {
    const BodyField::LegShape& leg = m.field.legs[side];
    const LegRoles& roles = m.roles.legs[side];
    const std::string prefix = side == 0 ? "left_" : "right_";
    const auto near = [side](const RegionValues& r) { return r.legs[side] <= nearest(r); };
    const auto end = [](const Loft& l) { return Vec3(l.a + l.axis * l.length); };
    add(prefix + "thigh", roles.upper, ellipsoidAlong(leg.thigh.a, end(leg.thigh), 0.074 * s, 0.07 * s), 0.03,
        [&, near](const Vec3& p, const RegionValues& r) {
          return near(r) && leg.thigh.along(p) < 1 && leg.shin.along(p) < 0.02;
        });
    add(prefix + "shin", roles.lower, ellipsoidAlong(leg.shin.a, end(leg.shin), 0.045 * s, 0.06 * s), 0.03,
        [&, near](const Vec3& p, const RegionValues& r) {
          const double t = leg.shin.along(p);
          return near(r) && t > 0.02 && t < 0.95;
        });
    const int foot = roles.foot >= 0 ? roles.foot : roles.lower;
    add(prefix + "foot", foot, ellipsoidAlong(leg.foot.a, end(leg.foot), 0.035 * s, 0.03 * s), 0.03,
        [&, near](const Vec3& p, const RegionValues& r) { return near(r) && leg.shin.along(p) >= 0.92; });
  }
};

}  // namespace

std::vector<BodyPart> mannequinParts(const Mannequin& mannequin) {
  Sorter sorter(mannequin);
  sorter.addHead();
  sorter.addTrunk();
  // Hair lies on these: rather a little too full than cut by the skin.
  for (BodyPart& part : sorter.parts)
    if (part.name != "head" && part.name != "jaw") part.outside = 4;
  for (int side = 0; side < 2; ++side) {
    if (mannequin.field.arms[side].present) sorter.addArm(side);
    if (mannequin.field.legs[side].present) sorter.addLeg(side);
  }
  return std::move(sorter.parts);
}

}  // namespace app
