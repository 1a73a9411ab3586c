#include "app/figure/cover_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace app {
namespace {

using CoverParams = Eigen::Matrix<double, 9, 1>;  // centre shift (m), rotation vector (rad), change of radii (m)

constexpr double kMinRadius = 0.005;  // m
constexpr double kDeep = 0.04;        // m: what lies deeper does not count
constexpr double kTight = 0.0007;     // m: own points are to lie so far inside
constexpr double kOutside = 8;        // weight of an own point that sticks out
constexpr double kFarOut = 0.002;     // m out, at which that doubles

BodyEllipsoid movedCover(const BodyEllipsoid& start, const CoverParams& x) {
  BodyEllipsoid e = start;
  e.center += x.head<3>();
  const Vec3 turn = x.segment<3>(3);
  if (const double angle = turn.norm(); angle > 1e-12)
    e.rotation = (Eigen::AngleAxisd(angle, turn / angle) * start.rotation).normalized();
  e.radii = (start.radii + x.tail<3>()).cwiseMax(kMinRadius);
  return e;
}

double weightOf(const CoverPoint& p, double gap) {
  const double out = gap + kTight;
  if (p.own && out > 0) return kOutside * p.weight * (1 + (out / kFarOut) * (out / kFarOut));
  if (gap > 0 || gap < -kDeep) return 0;
  const double in = 1 + gap / kDeep;  // fades to nothing
  return p.weight * in;
}

double costOf(std::span<const CoverPoint> points, const BodyEllipsoid& e, const CoverParams& x,
              const CoverParams& held) {
  double cost = held.cwiseProduct(x).squaredNorm();
  for (const CoverPoint& p : points) {
    const double gap = ellipsoidGap(e, p.position), target = p.own ? gap + kTight : gap;
    cost += weightOf(p, gap) * target * target;
  }
  return cost;
}

// Derivatives of the gap by the parameters around `e`, of first order.
CoverParams slopeOf(const BodyEllipsoid& e, const Eigen::Matrix3d& axes, const Vec3& p) {
  const Vec3 arm = p - e.center, u = (axes.transpose() * arm).cwiseQuotient(e.radii);
  const Vec3 gradient = u.cwiseQuotient(e.radii);
  const double steep = std::max(gradient.norm(), 1e-9);
  const Vec3 normal = axes * gradient / steep;
  CoverParams slope;
  slope.head<3>() = -normal;
  slope.segment<3>(3) = arm.cross(normal) * -1;
  slope.tail<3>() = -u.cwiseAbs2().cwiseQuotient(e.radii) / steep;
  return slope;
}

}  // namespace

BodyEllipsoid fitCover(std::span<const CoverPoint> points, const BodyEllipsoid& start, double hold) {
  double total = 0;
  for (const CoverPoint& p : points) total += p.weight;
  CoverParams held = CoverParams::Constant(std::sqrt(std::max(total, 1e-12)) * 0.01 / hold);
  held.segment<3>(3) *= start.radii.mean();
  CoverParams x = CoverParams::Zero();
  BodyEllipsoid e = start;
  double cost = costOf(points, e, x, held), damping = 1e-3;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::Matrix3d axes = e.rotation.toRotationMatrix();
    Eigen::Matrix<double, 9, 9> normal = held.cwiseAbs2().asDiagonal();
    CoverParams gradient = held.cwiseAbs2().cwiseProduct(x);
    for (const CoverPoint& p : points) {
      const double gap = ellipsoidGap(e, p.position), weight = weightOf(p, gap);
      if (weight == 0) continue;
      const CoverParams slope = slopeOf(e, axes, p.position);
      normal += weight * slope * slope.transpose();
      gradient += weight * (p.own ? gap + kTight : gap) * slope;
    }
    bool improved = false;
    for (int attempt = 0; attempt < 6 && !improved; ++attempt) {
      Eigen::Matrix<double, 9, 9> damped = normal;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-12;
      const CoverParams next = x - damped.ldlt().solve(gradient);
      const BodyEllipsoid there = movedCover(start, next);
      const double c = costOf(points, there, next, held);
      if (!(c < cost)) {
        damping *= 8;
        continue;
      }
      const bool done = cost - c < 1e-4 * cost;
      improved = true, x = next, e = there, cost = c;
      damping = std::max(damping * 0.3, 1e-7);
      if (done) return e;
    }
    if (!improved) break;
  }
  return e;
}

}  // namespace app
