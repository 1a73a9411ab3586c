// The head of the mannequin, in head units (chin to crown = 1): a cranium, a face lofted from chin to brow, and the
// soft features of a shop-window figure. Proportions follow the sculptor's canon: eyes half way up, nose base a third,
// mouth two ninths above the chin; pupils 0.26 apart, mouth 0.21 and nose 0.14 wide, cheekbones 0.56 (Farkas 1994).
#include <algorithm>
#include <array>
#include <cmath>

#include "app/figure/mannequin_field.h"
#include "app/figure/smoothstep.h"

namespace app {

namespace {

double egg(const Vec3& p, const Vec3& r) {
  const Vec3 u = p.cwiseQuotient(r);
  const double k0 = u.norm(), k1 = u.cwiseQuotient(r).norm();
  if (k0 < 0.2) return (k0 - 1) * r.minCoeff();
  return k0 * (k0 - 1) / k1;
}

double cranium(const Vec3& q) {
  const Vec3 p = q - Vec3(0, 0.625, -0.045);
  // Narrower at the temples than at the back; fuller above the nape than at the brow.
  const double narrow = 1 + 0.13 * smoothstep(-0.35, 0.45, p.z());
  const double ry = p.y() > 0 ? 0.375 : 0.36, rz = p.z() > 0 ? 0.405 : 0.425;
  const double skull = egg(Vec3(p.x() * narrow, p.y(), p.z()), Vec3(0.330, ry, rz));
  const double forehead = egg(q - Vec3(0, 0.68, 0.155), Vec3(0.235, 0.205, 0.215));
  return smoothMin(skull, forehead, 0.16);
}

const Loft& faceLoft() {
  // Levels from chin to forehead; above the brow the face sinks into the cranium.
  constexpr double low = 0.03, high = 0.84;
  struct Level {
    double y, side, front, back, shift;
  };
  constexpr std::array<Level, 10> levels{{{0.030, 0.092, 0.062, 0.085, 0.268},
                                          {0.090, 0.146, 0.100, 0.150, 0.252},
                                          {0.160, 0.192, 0.138, 0.200, 0.226},
                                          {0.240, 0.228, 0.172, 0.240, 0.196},
                                          {0.330, 0.256, 0.210, 0.258, 0.160},
                                          {0.430, 0.274, 0.238, 0.252, 0.132},
                                          {0.540, 0.270, 0.246, 0.250, 0.114},
                                          {0.640, 0.245, 0.238, 0.245, 0.108},
                                          {0.740, 0.205, 0.205, 0.220, 0.093},
                                          {0.840, 0.130, 0.130, 0.150, 0.080}}};
  static const Loft loft = [&] {
    std::vector<Section> sections;
    for (const Level& l : levels) sections.push_back({(l.y - low) / (high - low), l.side, l.front, l.back, l.shift});
    return makeLoft(Vec3(0, low, 0), Vec3(0, high, 0), Vec3::UnitZ(), std::move(sections), {0.035, 0.06});
  }();
  return loft;
}

double nose(const Vec3& q) {
  const RoundCone bridge{Vec3(0, 0.560, 0.318), Vec3(0, 0.374, 0.410), 0.0240, 0.0260};
  const Vec3 m(std::abs(q.x()), q.y(), q.z());
  const double tip = egg(q - Vec3(0, 0.358, 0.412), Vec3(0.037, 0.034, 0.040));
  const double wing = egg(m - Vec3(0.043, 0.340, 0.372), Vec3(0.027, 0.027, 0.038));
  const double column = egg(q - Vec3(0, 0.328, 0.392), Vec3(0.014, 0.014, 0.036));
  return smoothMin(smoothMin(bridge.value(q), tip, 0.046), smoothMin(wing, column, 0.024), 0.046);
}

// Lips: two soft rolls that follow the curve of the teeth and part in a dip; the upper one has a bow.
double lips(const Vec3& q, double d) {
  const double x = std::abs(q.x()), x2 = x * x, curve = 1.7 * x2, smile = 0.6 * x2;
  const double bow = 0.006 * std::exp(-std::pow((x - 0.030) / 0.018, 2));
  const double upper = egg(q - Vec3(0, 0.226 + smile + bow, 0.352 - curve), Vec3(0.106, 0.028, 0.040));
  const double lower = egg(q - Vec3(0, 0.186 + smile, 0.342 - curve), Vec3(0.088, 0.034, 0.045));
  d = smoothMin(d, smoothMin(upper, lower, 0.012), 0.034);
  d = smoothMax(d, -egg(q - Vec3(0, 0.2070 + smile, 0.391 - curve), Vec3(0.110, 0.0060, 0.020)), 0.016);  // seam
  return smoothMax(d, -egg(q - Vec3(0, 0.268, 0.418), Vec3(0.014, 0.032, 0.024)), 0.030);                 // philtrum
}

}  // namespace

double headWithoutEars(const Vec3& q) {
  const Vec3 m(std::abs(q.x()), q.y(), q.z());  // the face is mirrored about x = 0
  double d = smoothMin(cranium(q), faceLoft().value(q), 0.16);
  // The jaw: from the chin to its angles, and up to the ears.
  static const Eigen::Matrix3d jaw_tilt = Eigen::AngleAxisd(0.40, Vec3::UnitX()).toRotationMatrix();
  d = smoothMin(d, egg(jaw_tilt.transpose() * (q - Vec3(0, 0.190, 0.150)), Vec3(0.182, 0.108, 0.205)), 0.10);
  static const RoundCone jaw_body{Vec3(0.120, 0.234, 0.092), Vec3(0.042, 0.084, 0.260), 0.054, 0.048};
  static const RoundCone jaw_branch{Vec3(0.120, 0.234, 0.092), Vec3(0.196, 0.400, 0.070), 0.054, 0.066};
  d = smoothMin(d, smoothMin(jaw_body.value(m), jaw_branch.value(m), 0.08), 0.15);
  d = smoothMin(d, egg(q - Vec3(0, 0.074, 0.290), Vec3(0.070, 0.054, 0.064)), 0.08);        // chin
  d = smoothMin(d, egg(m - Vec3(0.176, 0.402, 0.192), Vec3(0.098, 0.086, 0.112)), 0.13);    // cheeks
  d = smoothMin(d, egg(m - Vec3(0.098, 0.592, 0.244), Vec3(0.112, 0.058, 0.074)), 0.10);    // brows
  d = smoothMax(d, -egg(m - Vec3(0.120, 0.520, 0.452), Vec3(0.094, 0.054, 0.120)), 0.080);  // eye sockets
  d = smoothMin(d, egg(m - Vec3(0.131, 0.502, 0.266), Vec3(0.080, 0.066, 0.086)), 0.034);   // closed lids
  d = smoothMin(d, nose(q), 0.060);
  return lips(q, d);
}

const std::array<HeadEllipsoid, 2>& noseEllipsoids() {
  static const std::array<HeadEllipsoid, 2> nose{
      HeadEllipsoid{Vec3(0, 0.4894, 0.3416), Vec3(0.0350, 0.1997, 0.0420), -0.5045},
      HeadEllipsoid{Vec3(0, 0.3484, 0.3009), Vec3(0.0803, 0.0761, 0.1576), -0.0885}};
  return nose;
}

double headValue(const Vec3& q) {
  const double d = headWithoutEars(q);
  if (std::abs(q.x()) < 0.18 || std::abs(q.z()) > 0.3) return d;
  const Vec3 m(std::abs(q.x()), q.y(), q.z());
  // Ears lean back and stand off a little; a shallow bowl keeps them from looking like buttons.
  const Eigen::AngleAxisd lean(-0.20, Vec3::UnitX()), splay(-0.26, Vec3::UnitY());
  const Vec3 e = (splay * lean).toRotationMatrix().transpose() * (m - Vec3(0.312, 0.470, -0.040));
  // Narrower at the lobe than at the top.
  const Vec3 tapered(e.x(), e.y(), e.z() * (1.15 - 1.6 * e.y()));
  const double shell = egg(tapered, Vec3(0.030, 0.112, 0.068));
  const double bowl = egg(e - Vec3(0.030, 0.022, 0.012), Vec3(0.022, 0.060, 0.034));
  return smoothMin(d, smoothMax(shell, -bowl, 0.028), 0.040);
}

}  // namespace app
