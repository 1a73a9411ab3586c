// A step takes no memory once it is warm: every allocation of the program is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>

#include "render/strands/strand_growth.h"
#include "sim/step.h"
#include "tests/synthetic_hair.h"
#include "tests/test_meshes.h"

namespace {
bool counting = false;
long allocations = 0;

void* countedAllocation(std::size_t size) {
  if (counting) ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) {
  return countedAllocation(size);
}
void* operator new[](std::size_t size) {
  return countedAllocation(size);
}
void* operator new(std::size_t size, std::align_val_t line) {
  if (counting) ++allocations;
  const std::size_t at = static_cast<std::size_t>(line);
  if (void* p = std::aligned_alloc(at, (size + at - 1) / at * at)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
// std::stable_sort asks for its buffer in this way.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  if (counting) ++allocations;
  return std::malloc(size);
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete[](void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}

namespace {

using sim::Integrator;
using sim::Solver;
using sim::Vec3;
using test::Hair;
using test::shake;

constexpr double kFrame = 1.0 / 60;

TEST(Allocation, NoneOnceWarm) {
  for (const Solver solver : {Solver::kPaper, Solver::kDefault}) {
    for (const Integrator integrator : {Integrator::kLinearizedEuler, Integrator::kBdf2}) {
      sim::SimParams params = test::tautHair();
      params.solver = solver;
      params.integrator = integrator;
      params.tolerance = 1e-3;
      Hair hair(test::combedShape({}), params);
      shake(hair, 12);
      allocations = 0;
      for (int n = 0; n < 5; ++n) {
        hair.bodies[0].center += kFrame * hair.bodies[0].velocity;
        counting = true;
        const sim::StepReport report = hair.step(kFrame);
        counting = false;
        EXPECT_GT(report.contacts + report.corrected, 0) << "contacts took part";
      }
      EXPECT_EQ(allocations, 0) << "integrator " << static_cast<int>(integrator) << ", solver "
                                << static_cast<int>(solver);
    }
  }
}

// The same where the balance of gravity follows the parameters in slices, inner vertices collide as well, and bundles
// with one another.
TEST(Allocation, NoneWithEveryOptionOnceWarm) {
  sim::SimParams params = test::tautHair();
  params.collide_inner = params.self_collide = true;
  Hair hair(test::combedShape({}), params);
  hair.context.refreshGradually(true);
  shake(hair, 12);
  allocations = 0;
  for (int n = 0; n < 5; ++n) {
    hair.bodies[0].center += kFrame * hair.bodies[0].velocity;
    counting = true;
    hair.step(kFrame);
    counting = false;
  }
  EXPECT_EQ(allocations, 0);
}

// Nor where pins come and go.
TEST(Allocation, NoneWithPinsOnceWarm) {
  for (const sim::Precision precision : {sim::Precision::kFloat, sim::Precision::kDouble}) {
    sim::SimParams params;
    params.precision = precision;
    Hair hair(test::combedShape({}), params);
    const auto pins = test::pinnedWhereTheyAre(hair.mesh);
    allocations = 0;
    for (int n = 0; n < 40; ++n) {
      hair.pins.assign(pins.begin(), pins.begin() + (n % 4 < 2 ? 3 : 0));
      for (std::size_t p = 0; p < hair.pins.size(); p += 2) hair.pins[p].stiffness = INFINITY;
      counting = n >= 8;
      const sim::StepReport report = hair.step(kFrame);
      counting = false;
      EXPECT_EQ(report.pins, static_cast<int>(hair.pins.size()));
    }
    EXPECT_EQ(allocations, 0) << "precision " << static_cast<int>(precision);
  }
}

// Nor the first time that the head is thrown about and that bodies come from all sides, in any precision.
TEST(Allocation, NoneInTheFirstViolentStep) {
  for (const sim::Precision precision : {sim::Precision::kFloat, sim::Precision::kDouble}) {
    for (const bool self : {false, true}) {
      sim::SimParams params;
      params.precision = precision;
      params.self_collide = self;
      test::PatchOptions o;
      o.layers = 12;
      Hair hair(test::combedShape(o), params);
      hair.bodies.resize(2);
      for (sim::Ellipsoid& body : hair.bodies) body.center = Vec3(0, 5, 0), body.radii = Vec3(0.05, 0.08, 0.06);
      for (int n = 0; n < 3; ++n) hair.step(kFrame);
      const auto rest = hair.roots;
      allocations = 0;
      double way = 0;
      int most = 0;
      for (int n = 0; n < 60; ++n) {
        const Eigen::AngleAxisd turn(2 * std::sin(1.1 * n), Vec3(1, 0.3, 0.2).normalized());
        for (std::size_t c = 0; c < rest.size(); ++c) hair.roots[c] = turn * rest[c];
        for (int b = 0; b < 2; ++b) {
          const Vec3 axis(b, 0, 1 - b);
          hair.bodies[b].velocity = 0.17 * 30 * std::cos(0.5 * n) * axis;
          hair.bodies[b].center = Vec3(0, -0.12, 0) + 0.17 * std::sin(0.5 * n) * axis;
        }
        const std::vector<Vec3> before = hair.state.positions;
        counting = true;
        const sim::StepReport report = hair.step(kFrame);
        counting = false;
        way = std::max(way, test::largestDistance(before, hair.state.positions));
        most = std::max(most, report.contacts);
      }
      EXPECT_EQ(allocations, 0) << "precision " << static_cast<int>(precision) << ", self-contact " << self;
      EXPECT_GT(way, 0.3 * hair.mesh.hair_length) << "no step was violent";
      EXPECT_GT(most, hair.mesh.columnCount());
    }
  }
}

// Nor while hair that hangs still is compared with a reference hair (sim/stabilization/reference_hair.h).
TEST(Allocation, NoneWhileAReferenceHairSettles) {
  sim::SimParams params = test::tautHair();
  params.sag_free = false;  // so that the hair hangs still away from its rest shape
  params.bend /= 20;
  params.air_drag = 5;
  Hair hair(test::combedShape({}), params);
  for (int n = 0; n < 30; ++n) hair.step(kFrame);
  allocations = 0;
  for (int n = 0; n < 600; ++n) {
    counting = true;
    hair.step(kFrame);
    counting = false;
  }
  EXPECT_EQ(allocations, 0);
}

// Nor to grow strands, nor to take up the positions that they grow from.
TEST(Allocation, NoneToGrowStrands) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::StrandGrowth growth(hair.faces, hair.positions, 200, 3, {});
  std::vector<render::CurvePoint> points(static_cast<std::size_t>(growth.maxPoints()));
  float sum = 0;
  allocations = 0;
  counting = true;
  growth.setPositions(hair.positions);
  for (int number = 0; number < growth.strandCount(); ++number) {
    const render::Strand strand = growth.strand(number);
    growth.growEven(strand, points);
    sum += points.back().position.y();
    sum += static_cast<float>(growth.growDrawn(strand, points));
  }
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(sum, 0);
}

}  // namespace
