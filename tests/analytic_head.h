// A head on a neck and shoulders made of a few smooth solids: what hair styles are tried on where no character is
// loaded.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/styles/hair_styles.h"

namespace tests {

using sim::Vec3;

// Distance to an ellipsoid, first order: exact on the surface, within a few per cent nearby.
inline double ellipsoidDistance(const Vec3& p, const Vec3& center, const Vec3& radii) {
  const Vec3 q = (p - center).cwiseQuotient(radii);
  const double value = q.norm(), slope = q.cwiseQuotient(radii).norm();
  return slope > 1e-12 ? value * (value - 1) / slope : -radii.minCoeff();
}

// Distance to a cone with round ends.
inline double coneDistance(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a, double radius_b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - (radius_a + t * (radius_b - radius_a));
}

// Union with a fillet of about size k (polynomial blend).
inline double blend(double a, double b, double k) {
  const double h = std::clamp(0.5 + 0.5 * (b - a) / k, 0.0, 1.0);
  return b + (a - b) * h - k * h * (1 - h);
}

// The origin is the middle of the cranium level with the top of the ears; 1.70 m figure, 23 cm from chin to crown.
inline double headDistance(const Vec3& p) {
  const double cranium = ellipsoidDistance(p, {0, 0.022, -0.012}, {0.076, 0.094, 0.098});
  const double jaw = ellipsoidDistance(p, {0, -0.055, 0.035}, {0.052, 0.062, 0.058});
  return blend(cranium, jaw, 0.03);
}

inline double bodyDistance(const Vec3& p) {
  double d = headDistance(p);
  d = blend(d, coneDistance(p, {0, -0.05, -0.025}, {0, -0.20, -0.045}, 0.053, 0.060), 0.02);
  for (const double side : {1.0, -1.0})
    d = blend(d, coneDistance(p, {0, -0.215, -0.045}, {side * 0.17, -0.27, -0.05}, 0.045, 0.055), 0.04);
  d = blend(d, ellipsoidDistance(p, {0, -0.38, -0.02}, {0.165, 0.20, 0.095}), 0.05);
  return blend(d, ellipsoidDistance(p, {0, -0.62, -0.03}, {0.13, 0.25, 0.09}), 0.05);
}

// The head alone, sampled along rays from the origin.
inline app::Scalp analyticScalp() {
  app::Scalp scalp;
  scalp.head_height = 0.23;
  scalp.rows = 65;
  scalp.columns = 128;
  scalp.radius.resize(65 * 128);
  for (int i = 0; i < 65; ++i) {
    for (int j = 0; j < 128; ++j) {
      const double polar = i * std::numbers::pi / 64, azimuth = j * 2 * std::numbers::pi / 128;
      const Vec3 d(std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth));
      double inside = 0.01, outside = 0.3;
      for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (inside + outside);
        (bodyDistance(d * middle) < 0 ? inside : outside) = middle;
      }
      scalp.radius[i * 128 + j] = 0.5 * (inside + outside);
    }
  }
  return scalp;
}

}  // namespace tests
