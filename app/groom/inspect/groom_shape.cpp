#include "app/groom/inspect/groom_shape.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/files/median.h"

namespace app {

using Eigen::Vector3f;

namespace {

// |p|^2 = 2 c . p + (r^2 - |c|^2), least squares in c and the bracket, about the points' middle.
SphereFit leastSquares(const std::vector<Vector3f>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Vector3f& p : points) middle += p.cast<double>() / static_cast<double>(points.size());
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Vector3f& p : points) {
    const Eigen::Vector3d q = p.cast<double>() - middle;
    const Eigen::Vector4d row(2 * q.x(), 2 * q.y(), 2 * q.z(), 1);
    normal += row * row.transpose();
    right += row * q.squaredNorm();
  }
  const Eigen::Vector4d solved = normal.ldlt().solve(right);
  const Eigen::Vector3d center = solved.head<3>();
  return {(center + middle).cast<float>(),
          static_cast<float>(std::sqrt(std::max(solved[3] + center.squaredNorm(), 0.0))), 0, 0};
}

std::vector<float> residuals(const SphereFit& fit, const std::vector<Vector3f>& points) {
  std::vector<float> all;
  for (const Vector3f& p : points) all.push_back(std::abs((p - fit.center).norm() - fit.radius));
  return all;
}

float coverageOf(const SphereFit& fit, const std::vector<Vector3f>& points) {
  Vector3f mean = Vector3f::Zero();
  Eigen::Matrix3f square = Eigen::Matrix3f::Zero();
  const float share = 1 / static_cast<float>(points.size());
  for (const Vector3f& p : points) {
    const Vector3f direction = (p - fit.center).normalized();
    mean += share * direction;
    square += share * direction * direction.transpose();
  }
  const Eigen::Matrix3f covariance = square - mean * mean.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

SphereFit fitSphere(const std::vector<Vector3f>& points) {
  if (points.size() < 8) return {};
  SphereFit fit = leastSquares(points);
  for (int round = 0; round < 3; ++round) {
    const std::vector<float> off = residuals(fit, points);
    const float far = 3 * median(off);
    std::vector<Vector3f> near;
    for (std::size_t n = 0; n < points.size(); ++n) {
      if (off[n] <= far) near.push_back(points[n]);
    }
    if (near.size() < 8) break;
    fit = leastSquares(near);
  }
  fit.coverage = coverageOf(fit, points);
  fit.spread = fit.radius > 0 ? median(residuals(fit, points)) / fit.radius : 1;
  return fit;
}

StrandFault strandFault(const Groom& groom, std::size_t strand, float size) {
  const std::span<const Vector3f> points = groom.strand(strand);
  if (points.size() < 2) return StrandFault::kTooFewPoints;
  float length = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!points[p].allFinite()) return StrandFault::kNonFinite;
    if (p > 0) length += (points[p] - points[p - 1]).norm();
  }
  return length > 1e-6f * size ? StrandFault::kNone : StrandFault::kZeroLength;
}

float groomSize(const Groom& groom) {
  Vector3f low = Vector3f::Constant(HUGE_VALF), high = -low;
  for (const Vector3f& p : groom.points) {
    if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
  }
  return std::max((high - low).maxCoeff(), 0.0f);
}

namespace {

constexpr float kLeap = 0.75f;  // of the box's largest side, from a point to the next

// The box about those strands that strandEnds describes.
Eigen::AlignedBox3f boxOfMost(const Groom& groom, const std::vector<std::size_t>& strands) {
  constexpr double kOutermost = 0.02;
  constexpr float kGrown = 0.5f;
  Vector3f low, high;
  const auto skipped = static_cast<std::ptrdiff_t>(kOutermost * 2 * static_cast<double>(strands.size()));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> at;
    for (const std::size_t s : strands) {
      at.push_back(groom.strand(s).front()[axis]);
      at.push_back(groom.strand(s).back()[axis]);
    }
    std::nth_element(at.begin(), at.begin() + skipped, at.end());
    low[axis] = at[static_cast<std::size_t>(skipped)];
    std::nth_element(at.begin(), at.end() - 1 - skipped, at.end());
    high[axis] = *(at.end() - 1 - skipped);
  }
  const Vector3f grown = Vector3f::Constant(kGrown * (high - low).maxCoeff());
  return {low - grown, high + grown};
}

// Takes strands that are astray out of `strands`.
std::vector<std::size_t> takeAstray(const Groom& groom, std::vector<std::size_t>& strands) {
  if (strands.size() < kMinRoots) return {};
  const Eigen::AlignedBox3f box = boxOfMost(groom, strands);
  const float leap = kLeap * box.sizes().maxCoeff();
  const auto isAstray = [&](std::size_t s) {
    const std::span<const Vector3f> points = groom.strand(s);
    for (std::size_t p = 1; p < points.size(); ++p)
      if ((points[p] - points[p - 1]).norm() > leap) return true;
    return std::ranges::none_of(points, [&](const Vector3f& p) { return box.contains(p); });
  };
  std::vector<std::size_t> astray;
  std::ranges::copy_if(strands, std::back_inserter(astray), isAstray);
  std::erase_if(strands, [&](std::size_t s) { return std::ranges::binary_search(astray, s); });
  return astray;
}

}  // namespace

StrandEnds strandEnds(const Groom& groom, std::size_t most, bool one_head) {
  StrandEnds ends;
  const float size = groomSize(groom);
  std::vector<std::size_t> usable;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const StrandFault fault = strandFault(groom, s, size);
    if (fault == StrandFault::kNone) usable.push_back(s);
    ends.non_finite += fault == StrandFault::kNonFinite;
    ends.zero_length += fault == StrandFault::kZeroLength;
    ends.too_short += fault == StrandFault::kTooFewPoints;
  }
  if (one_head) ends.astray = takeAstray(groom, usable);
  const std::size_t count = std::min(most, usable.size());
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t s = usable[n * usable.size() / count];
    ends.strands.push_back(s);
    ends.first.push_back(groom.strand(s).front());
    ends.last.push_back(groom.strand(s).back());
  }
  return ends;
}

}  // namespace app
