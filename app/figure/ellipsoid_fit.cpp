#include "app/figure/ellipsoid_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace app {

namespace {

using Params = Eigen::Matrix<double, 9, 1>;  // centre shift (m), rotation vector (rad), change of radii (m)

constexpr double kOutlier = 0.010;             // m: gaps beyond count less and less
constexpr double kMinEllipsoidRadius = 0.005;  // m

BodyEllipsoid moved(const BodyEllipsoid& start, const Params& x) {
  BodyEllipsoid e = start;
  e.center += x.head<3>();
  const Vec3 turn = x.segment<3>(3);
  if (const double angle = turn.norm(); angle > 1e-12)
    e.rotation = (Eigen::AngleAxisd(angle, turn / angle) * start.rotation).normalized();
  e.radii = (start.radii + x.tail<3>()).cwiseMax(kMinEllipsoidRadius);
  return e;
}

struct Problem {
  std::span<const FitPoint> points;
  const BodyEllipsoid& start;
  double hold, total_weight, outside;

  // Residuals of the points, then of the nine parameters against the start.
  Eigen::VectorXd residuals(const Params& x) const {
    const BodyEllipsoid e = moved(start, x);
    const auto n = static_cast<Eigen::Index>(points.size());
    Eigen::VectorXd r(n + 9);
    for (Eigen::Index i = 0; i < n; ++i) r[i] = ellipsoidGap(e, points[i].position);
    const double size = start.radii.mean();
    for (int k = 0; k < 9; ++k) r[n + k] = (k >= 3 && k < 6 ? size : 1.0) * x[k] * kOutlier / hold;
    return r;
  }

  double share(Eigen::Index i, double gap) const { return points[i].weight / total_weight * (gap > 0 ? outside : 1); }

  Eigen::VectorXd weights(const Eigen::VectorXd& r) const {
    Eigen::VectorXd w(r.size());
    const auto n = static_cast<Eigen::Index>(points.size());
    for (Eigen::Index i = 0; i < n; ++i) w[i] = share(i, r[i]) / (1 + (r[i] / kOutlier) * (r[i] / kOutlier));
    w.tail<9>().setConstant(1.0 / 9);
    return w;
  }

  // The robust cost whose reweighting `weights` is.
  double cost(const Eigen::VectorXd& r) const {
    double sum = 0;
    const auto n = static_cast<Eigen::Index>(points.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double u = r[i] / kOutlier;
      sum += share(i, r[i]) * std::log1p(u * u);
    }
    return sum + r.tail<9>().squaredNorm() / (9 * kOutlier * kOutlier);
  }
};

}  // namespace

double ellipsoidGap(const BodyEllipsoid& e, const Vec3& p) {
  const Vec3 u = (e.rotation.conjugate() * (p - e.center)).cwiseQuotient(e.radii);
  const double k0 = u.norm(), k1 = u.cwiseQuotient(e.radii).norm();
  return k0 < 0.2 ? (k0 - 1) * e.radii.minCoeff() : k0 * (k0 - 1) / k1;
}

BodyEllipsoid principalEllipsoid(std::span<const FitPoint> points) {
  Vec3 mean = Vec3::Zero();
  double total = 0;
  for (const FitPoint& p : points) {
    mean += p.weight * p.position;
    total += p.weight;
  }
  mean /= total;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const FitPoint& p : points) scatter += p.weight / total * (p.position - mean) * (p.position - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) *= -1;
  BodyEllipsoid e;
  e.center = mean;
  e.rotation = Eigen::Quaterniond(axes);
  // A sphere's surface has variance r^2 / 3 along each axis.
  e.radii = (3 * solver.eigenvalues()).cwiseMax(kMinEllipsoidRadius * kMinEllipsoidRadius).cwiseSqrt();
  return e;
}

BodyEllipsoid fitEllipsoid(std::span<const FitPoint> points, const BodyEllipsoid& start, double hold, double outside) {
  double total = 0;
  for (const FitPoint& p : points) total += p.weight;
  const Problem problem{points, start, hold, std::max(total, 1e-12), outside};
  Params x = Params::Zero();
  Eigen::VectorXd r = problem.residuals(x);
  double cost = problem.cost(r), damping = 1e-3;
  for (int iteration = 0; iteration < 25; ++iteration) {
    Eigen::MatrixXd jacobian(r.size(), 9);
    for (int k = 0; k < 9; ++k) {
      Params forward = x;
      const double h = 1e-6;
      forward[k] += h;
      jacobian.col(k) = (problem.residuals(forward) - r) / h;
    }
    const Eigen::VectorXd w = problem.weights(r);
    const Eigen::Matrix<double, 9, 9> normal = jacobian.transpose() * w.asDiagonal() * jacobian;
    const Params gradient = jacobian.transpose() * w.cwiseProduct(r);
    bool improved = false;
    for (int attempt = 0; attempt < 6 && !improved; ++attempt) {
      Eigen::Matrix<double, 9, 9> damped = normal;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-9;
      const Params next = x - damped.ldlt().solve(gradient);
      const Eigen::VectorXd at_next = problem.residuals(next);
      if (const double c = problem.cost(at_next); c < cost) {
        improved = true;
        const bool done = cost - c < 1e-6 * cost;
        x = next;
        r = at_next;
        cost = c;
        damping = std::max(damping * 0.3, 1e-7);
        if (done) return moved(start, x);
      } else {
        damping *= 8;
      }
    }
    if (!improved) break;
  }
  return moved(start, x);
}

FitReport reportFit(std::span<const FitPoint> points, const BodyEllipsoid& e) {
  FitReport report;
  double total = 0;
  for (const FitPoint& p : points) {
    const double gap = ellipsoidGap(e, p.position);
    report.mean_gap += p.weight * gap;
    report.rms_gap += p.weight * gap * gap;
    report.max_gap = std::max(report.max_gap, std::abs(gap));
    total += p.weight;
  }
  report.mean_gap /= total;
  report.rms_gap = std::sqrt(report.rms_gap / total);
  return report;
}

}  // namespace app
