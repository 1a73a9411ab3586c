// The head of the mannequin, in head units (chin to crown = 1): a cranium, a face lofted from chin to brow, and the
// soft features of a shop-window figure. Proportions follow the sculptor's canon: eyes half way up, nose base a third,
// mouth two ninths above the chin.
#include <algorithm>
#include <cmath>

#include "app/mannequin_field.h"

namespace app {

namespace {

double egg(const Vec3& p, const Vec3& r) {
  const Vec3 u = p.cwiseQuotient(r);
  const double k0 = u.norm(), k1 = u.cwiseQuotient(r).norm();
  if (k0 < 0.2) return (k0 - 1) * r.minCoeff();
  return k0 * (k0 - 1) / k1;
}

double smoothstep(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
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
  static const Loft loft = makeLoft(Vec3(0, 0.02, 0), Vec3(0, 0.62, 0), Vec3::UnitZ(),
                                    {{0.00, 0.085, 0.070, 0.090, 0.290},
                                     {0.08, 0.125, 0.090, 0.170, 0.285},
                                     {0.20, 0.175, 0.130, 0.240, 0.245},
                                     {0.34, 0.212, 0.170, 0.260, 0.200},
                                     {0.50, 0.240, 0.215, 0.260, 0.158},
                                     {0.66, 0.258, 0.245, 0.250, 0.125},
                                     {0.82, 0.266, 0.250, 0.250, 0.112},
                                     {1.00, 0.262, 0.250, 0.250, 0.110}},
                                    {0.035, 0.05});
  return loft;
}

double nose(const Vec3& q) {
  const RoundCone bridge{Vec3(0, 0.545, 0.335), Vec3(0, 0.372, 0.437), 0.030, 0.041};
  const Vec3 m(std::abs(q.x()), q.y(), q.z());
  const double wing = egg(m - Vec3(0.046, 0.352, 0.392), Vec3(0.030, 0.029, 0.043));
  return smoothMin(bridge.value(q), wing, 0.035);
}

}  // namespace

double headWithoutEars(const Vec3& q) {
  const Vec3 m(std::abs(q.x()), q.y(), q.z());  // the face is mirrored about x = 0
  double d = smoothMin(cranium(q), faceLoft().value(q), 0.14);
  d = smoothMin(d, egg(m - Vec3(0.165, 0.42, 0.205), Vec3(0.085, 0.075, 0.115)), 0.09);     // cheekbones
  d = smoothMin(d, egg(q - Vec3(0, 0.075, 0.315), Vec3(0.085, 0.070, 0.070)), 0.07);        // chin
  d = smoothMax(d, -egg(m - Vec3(0.122, 0.520, 0.435), Vec3(0.092, 0.058, 0.085)), 0.075);  // eye sockets
  d = smoothMin(d, egg(m - Vec3(0.122, 0.512, 0.285), Vec3(0.072, 0.060, 0.070)), 0.025);   // closed lids
  d = smoothMin(d, nose(q), 0.045);
  // Lips: two soft rolls that follow the curve of the teeth.
  const double bow = 1.1 * q.x() * q.x();
  d = smoothMin(d, egg(q - Vec3(0, 0.262 - 0.5 * bow, 0.372 - bow), Vec3(0.080, 0.024, 0.036)), 0.022);
  d = smoothMin(d, egg(q - Vec3(0, 0.219, 0.368 - bow), Vec3(0.066, 0.027, 0.038)), 0.022);
  return d;
}

double headValue(const Vec3& q) {
  double d = headWithoutEars(q);
  if (std::abs(q.x()) < 0.18 || std::abs(q.z()) > 0.3) return d;
  const Vec3 m(std::abs(q.x()), q.y(), q.z());
  // Ears lean back and stand off a little; a shallow bowl keeps them from looking like buttons.
  const Eigen::AngleAxisd lean(-0.22, Vec3::UnitX()), splay(-0.30, Vec3::UnitY());
  const Vec3 e = (splay * lean).toRotationMatrix().transpose() * (m - Vec3(0.318, 0.455, -0.035));
  const double shell = egg(e, Vec3(0.032, 0.128, 0.078));
  const double bowl = egg(e - Vec3(0.040, 0.020, 0.010), Vec3(0.030, 0.075, 0.042));
  return smoothMin(d, smoothMax(shell, -bowl, 0.03), 0.03);
}

}  // namespace app
