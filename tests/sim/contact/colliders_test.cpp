// The ellipsoid's closest point against brute force and against points whose answer is known by construction.
#include "sim/contact/colliders.h"

#include <gtest/gtest.h>

#include "tests/test_meshes.h"
#include "tests/sim_probes.h"

namespace colliders_test {

using sim::Ellipsoid;
using sim::SurfacePoint;
using sim::Vec3;

// Needles, discs, eggs, spheres, and shapes with two equal radii, from 1 mm to 10 m.
Ellipsoid randomEllipsoid(test::Random& random, int kind) {
  Ellipsoid e;
  const double scale = std::pow(10, random(-2, 0));
  const double aspect = std::pow(10, random(0, 1));
  switch (kind % 6) {
    case 0:
      e.radii = Vec3(random(0.5, 2), random(0.5, 2), random(0.5, 2));
      break;
    case 1:
      e.radii = Vec3(1, 1, aspect);
      break;
    case 2:
      e.radii = Vec3(aspect, 1, aspect);
      break;
    case 3:
      e.radii = Vec3(1, 1, 1);
      break;
    case 4:
      e.radii = Vec3(1, aspect, 0.3 * aspect);
      break;
    default:
      e.radii = Vec3(1, 1 + 1e-9, 1 + 2e-9);
      break;
  }
  e.radii *= scale;
  e.center = random.vector(1);
  e.rotation = random.rotation();
  return e;
}

Vec3 toLocal(const Ellipsoid& e, const Vec3& p) {
  return e.rotation.conjugate() * (p - e.center);
}

// Brute force in the local frame: the best of a grid of directions, refined by shrinking pattern search.
double bruteDistance(const Vec3& radii, const Vec3& p) {
  const auto distanceAt = [&](double u, double v) {
    const Vec3 s(radii.x() * std::cos(u) * std::cos(v), radii.y() * std::sin(v), radii.z() * std::sin(u) * std::cos(v));
    return (s - p).norm();
  };
  struct Start {
    double d, u, v;
  };
  std::vector<Start> starts;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j <= 32; ++j) {
      const double u = 2 * M_PI * i / 64, v = M_PI * (j / 32.0 - 0.5);
      starts.push_back({distanceAt(u, v), u, v});
    }
  }
  std::partial_sort(starts.begin(), starts.begin() + 8, starts.end(), [](auto& a, auto& b) { return a.d < b.d; });
  double best = starts[0].d;
  for (int k = 0; k < 8; ++k) {
    Start s = starts[k];
    for (double step = 0.1; step > 1e-9; step *= 0.6) {
      for (bool better = true; better;) {
        better = false;
        for (int m = 0; m < 8; ++m) {
          const double u = s.u + step * std::cos(m * M_PI / 4), v = s.v + step * std::sin(m * M_PI / 4);
          const double d = distanceAt(u, v);
          if (d < s.d) s = {d, u, v}, better = true;
        }
      }
    }
    best = std::min(best, s.d);
  }
  return best;
}

// What every answer must satisfy, whatever the point.
void expectConsistent(const Ellipsoid& e, const Vec3& p, const SurfacePoint& s) {
  const double size = e.radii.maxCoeff(), far = (p - e.center).norm() + size;
  ASSERT_TRUE(s.point.allFinite() && s.normal.allFinite() && std::isfinite(s.distance));
  EXPECT_NEAR(s.normal.norm(), 1, 1e-12);
  EXPECT_NEAR(toLocal(e, s.point).cwiseQuotient(e.radii).norm(), 1, 1e-9) << "on the surface";
  EXPECT_LT((p - s.point - s.distance * s.normal).norm(), 1e-7 * far) << "reached along the normal";
  EXPECT_EQ(s.distance < 0, test::implicitValue(e, p) < 0);
}

TEST(Ellipsoid, ClosestPointIsNoFartherThanBruteForceFindsOne) {
  test::Random random(1);
  double worst = 0;
  for (int trial = 0; trial < 240; ++trial) {
    const Ellipsoid e = randomEllipsoid(random, trial);
    Vec3 local;
    for (int i = 0; i < 3; ++i) local[i] = e.radii[i] * random(-1, 1) * (trial % 2 ? 2.0 : 0.6);
    if (trial % 5 == 0) local[trial % 3] = 0;  // symmetry planes
    if (trial % 15 == 0) local[(trial + 1) % 3] = 0;
    const Vec3 p = e.center + e.rotation * local;
    const SurfacePoint s = sim::closestPoint(e, p);
    expectConsistent(e, p, s);
    const double brute = bruteDistance(e.radii, local), size = e.radii.maxCoeff();
    EXPECT_NEAR(std::abs(s.distance), brute, 1e-7 * size)
        << "radii " << e.radii.transpose() << " at " << local.transpose();
    EXPECT_LE(std::abs(s.distance), brute + 1e-12 * size);
    worst = std::max(worst, std::abs(std::abs(s.distance) - brute) / size);
  }
  std::printf("worst difference %.1e of the largest radius\n", worst);
}

TEST(Ellipsoid, PointsAlongANormalComeBackToItsFootWithinAPicometre) {
  test::Random random(2);
  double worst = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    Ellipsoid e = randomEllipsoid(random, trial);
    e.center = random.vector(0.1);
    const Vec3 on = random.direction().cwiseProduct(e.radii);
    const Vec3 normal = on.cwiseQuotient(e.radii).cwiseQuotient(e.radii).normalized();
    // Inside, the foot is the closest point as long as the depth stays below the smallest radius of curvature.
    const double shortest = e.radii.minCoeff(), longest = e.radii.maxCoeff();
    const double distance = random(-0.98, 2) * shortest * (trial % 2 ? 1 : shortest / longest);
    if (distance < -0.98 * shortest * shortest / longest) continue;
    const Vec3 p = e.center + e.rotation * Vec3(on + distance * normal);
    const SurfacePoint s = sim::closestPoint(e, p);
    worst = std::max(worst, std::abs(s.distance - distance));
    EXPECT_NEAR(s.distance, distance, 1e-12);
    EXPECT_LT((s.normal - e.rotation * normal).norm(), 1e-5);
  }
  std::printf("worst error %.1e m\n", worst);
}

TEST(Ellipsoid, CentreAndDegeneratePointsHaveAProperAnswer) {
  test::Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    const Ellipsoid e = randomEllipsoid(random, trial);
    const double shortest = e.radii.minCoeff(), longest = e.radii.maxCoeff();
    const SurfacePoint centre = sim::closestPoint(e, e.center);
    expectConsistent(e, e.center, centre);
    EXPECT_NEAR(centre.distance, -shortest, 1e-12 * longest);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 direction = Vec3::Zero();
      direction[axis] = trial % 2 ? 1 : -1;
      // The pole itself, outside it, and the centre but for rounding.
      const Vec3 pole = e.center + e.rotation * Vec3(e.radii[axis] * direction);
      EXPECT_NEAR(sim::closestPoint(e, pole).distance, 0, 1e-12 * longest);
      const Vec3 outside = e.center + e.rotation * Vec3((e.radii[axis] + 3) * direction);
      EXPECT_NEAR(sim::closestPoint(e, outside).distance, 3, 1e-12 * (3 + longest));
      EXPECT_LT((sim::closestPoint(e, outside).normal - e.rotation * direction).norm(), 1e-9);
      const Vec3 nudged = e.center + e.rotation * Vec3(1e-300 * direction);
      expectConsistent(e, nudged, sim::closestPoint(e, nudged));
    }
  }
}

TEST(Ellipsoid, DistanceHasTheNormalAsItsGradientAndGrowsNoFasterThanThePointMoves) {
  test::Random random(4);
  for (int trial = 0; trial < 600; ++trial) {
    const Ellipsoid e = randomEllipsoid(random, trial);
    const double size = e.radii.minCoeff();
    const Vec3 p = e.center + random.vector(3 * e.radii.maxCoeff()), q = p + random.vector(size);
    const SurfacePoint s = sim::closestPoint(e, p);
    EXPECT_LE(std::abs(sim::closestPoint(e, q).distance - s.distance), (q - p).norm() + 1e-12);
    if (s.distance < 0.1 * size) continue;
    const Vec3 direction = random.direction();
    const double h = 1e-5 * size;
    const double slope =
        (sim::closestPoint(e, p + h * direction).distance - sim::closestPoint(e, p - h * direction).distance) / (2 * h);
    EXPECT_NEAR(slope, s.normal.dot(direction), 1e-6);
  }
}

TEST(Ellipsoid, SurfaceVelocityIsTheRigidMotionsDerivative) {
  test::Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    Ellipsoid e = randomEllipsoid(random, trial);
    e.velocity = random.vector(3);
    e.angular_velocity = random.vector(10);
    const Vec3 local = random.vector(0.5), p = e.center + e.rotation * local;
    const double h = 1e-6;
    const auto at = [&](double t) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(e.angular_velocity.norm() * t, e.angular_velocity.normalized()));
      return Vec3(e.center + t * e.velocity + turn * (e.rotation * local));
    };
    EXPECT_LT(((at(h) - at(-h)) / (2 * h) - sim::surfaceVelocity(e, p)).norm(), 1e-7);
  }
}

}  // namespace colliders_test
