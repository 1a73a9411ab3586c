// Continuous collision: what passed through a body within a step is found as dense samples of its way find it, for a
// bounded number of closest points; and a step keeps to the work that it is given.
#include <gtest/gtest.h>

#include <random>

#include "sim/contact/contact.h"
#include "tests/test_meshes.h"

namespace swept_contact_test {

using sim::Ellipsoid;
using sim::Vec3;

constexpr double kFrame = 1.0 / 60;
constexpr double kOffset = 0.003;  // m

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
Vec3 inBox(std::mt19937& random, double half) {
  return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}

struct Passage {
  Ellipsoid body;
  std::vector<Vec3> start, end;  // of one vertex
};

Passage randomPassage(std::mt19937& random) {
  Passage passage;
  passage.body.radii = Vec3(0.07, 0.07, 0.07) + inBox(random, 0.05);
  passage.body.center = inBox(random, 0.3);
  passage.body.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(uniform(random, 0, 3), inBox(random, 1).normalized()));
  passage.body.velocity = inBox(random, uniform(random, 0, 30));
  passage.body.angular_velocity = inBox(random, uniform(random, 0, 50));
  passage.start = {passage.body.center - kFrame * passage.body.velocity + inBox(random, 0.3)};
  passage.end = {passage.body.center + inBox(random, 0.3)};
  return passage;
}

// Gap (m) between the vertex and the body's offset surface at a share of the step.
double gapAt(const Passage& passage, double share) {
  Ellipsoid body = passage.body;
  const double back = (1 - share) * kFrame, turn = -back * body.angular_velocity.norm();
  body.center -= back * body.velocity;
  body.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(turn, body.angular_velocity.normalized())) * body.rotation;
  const Vec3 p = passage.start[0] + share * (passage.end[0] - passage.start[0]);
  return sim::closestPoint(body, p).distance - kOffset;
}

TEST(SweptContact, FindsWhatDenseSamplesOfTheWayFindAndPutsItOutsideForFewClosestPoints) {
  std::mt19937 random(7);
  int passed = 0, missed = 0, wrong = 0;
  long most = 0;
  for (int k = 0; k < 4000; ++k) {
    const Passage passage = randomPassage(random);
    if (gapAt(passage, 0) < 0.004 || gapAt(passage, 1) < 0.004) continue;
    double deepest = INFINITY;
    for (int i = 0; i <= 300; ++i) deepest = std::min(deepest, gapAt(passage, i / 300.0));
    // A tenth of the thickness may be grazed; chords for arcs, and an ellipsoid for its offset surface, are off by a
    // few millimetres.
    const double grazed = 0.1 * passage.body.radii.minCoeff();
    const bool through = deepest<-grazed - 0.006, past = deepest> - grazed + 0.006;
    if (!through && !past) continue;
    long points = 0;
    sim::ContactScratch scratch;
    std::vector<sim::Penetration> found;
    const int vertex = 0;
    const sim::Colliders colliders{{&passage.body, 1}, {}, &points};
    sim::findPenetrations({{&vertex, 1}, colliders, passage.start, kFrame, {kOffset, 0.0006, 0.001}}, passage.end,
                          scratch, found);
    passed += through;
    missed += through && found.empty();
    wrong += past && !found.empty();
    most = std::max(most, points);
    if (!found.empty()) {
      EXPECT_GT(sim::closestPoint(passage.body, found[0].target).distance, kOffset - 1e-6);
    }
  }
  std::printf("%d of 4000 ways pass through; at most %ld closest points\n", passed, most);
  EXPECT_GT(passed, 200);
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(most, 6);
}

// A curtain and three bodies that strike through it.
struct Beaten {
  test::Hair hair;
  std::vector<Ellipsoid> bodies;

  Beaten() : hair(test::combedShape(curtain()), test::tautHair()), bodies(3) {
    for (int b = 0; b < 3; ++b) bodies[b].radii = Vec3(0.05, 0.15, 0.04);
  }
  static test::PatchOptions curtain() {
    test::PatchOptions o;
    o.nx = 6, o.nz = 4, o.layers = 8, o.length = 0.3, o.mixed = true;
    return o;
  }
  sim::StepReport step(int n, double max_work) {
    for (int b = 0; b < 3; ++b) {
      const double phase = 0.9 * n + 2.1 * b;
      const Vec3 center(0.25 * std::sin(phase), -0.2 + 0.05 * b, 0.25 * std::cos(1.3 * phase));
      bodies[b].velocity = (center - bodies[b].center) / kFrame;
      bodies[b].angular_velocity = Vec3(0, 20 * b, 5);
      bodies[b].center = center;
      bodies[b].rotation = Eigen::Quaterniond(Eigen::AngleAxisd(kFrame * bodies[b].angular_velocity.norm(),
                                                                bodies[b].angular_velocity.normalized())) *
                           bodies[b].rotation;
    }
    sim::StepInput input{hair.roots, bodies, n * kFrame};
    input.max_work = max_work;
    return sim::advance(hair.mesh, hair.params, input, kFrame, hair.context, hair.state);
  }
  // m, of the deepest external vertex.
  double depth() const {
    double most = 0;
    for (const int v : hair.mesh.external_vertices) {
      for (const Ellipsoid& body : bodies)
        most = std::max(most, -sim::closestPoint(body, hair.state.positions[v]).distance);
    }
    return most;
  }
};

// A pack of overlapping bodies that passes through the hair within a step, to and fro, as the body of a figure does
// whose clip is played at twenty times its speed.
TEST(StepWork, OfContactsIsBoundedWhereManyBodiesPassInOneStep) {
  Beaten beaten;
  std::vector<Ellipsoid>& bodies = beaten.bodies;
  bodies.resize(30);
  const int vertices = beaten.hair.mesh.vertexCount();
  double most = 0, deepest = 0;
  for (int n = 0; n < 40; ++n) {
    for (int b = 0; b < 30; ++b) {
      const Vec3 center(n % 2 ? 0.7 : -0.7, -0.3 + 0.01 * b, 0.1 * std::sin(b));
      bodies[b].radii = Vec3(0.08, 0.1, 0.12);
      bodies[b].velocity = (center - bodies[b].center) / kFrame;
      bodies[b].center = center;
    }
    const sim::StepInput input{beaten.hair.roots, bodies, n * kFrame};
    const sim::StepReport report =
        sim::advance(beaten.hair.mesh, beaten.hair.params, input, kFrame, beaten.hair.context, beaten.hair.state);
    if (n > 0) most = std::max(most, static_cast<double>(report.work.surface_points) / vertices);
    deepest = std::max(deepest, beaten.depth());
  }
  std::printf("at most %.1f closest points a vertex\n", most);
  EXPECT_GT(most, 3);
  EXPECT_LT(most, 8);
  EXPECT_LT(deepest, 1e-6);
}

TEST(StepWork, IsTheSameWheneverTheSameStepsAreTaken) {
  Beaten one, other;
  for (int n = 0; n < 60; ++n) {
    const sim::StepReport a = one.step(n, INFINITY), b = other.step(n, INFINITY);
    ASSERT_EQ(a.work_units, b.work_units) << n;
    ASSERT_GT(a.work_units, 0);
    ASSERT_EQ(a.work.iterations, a.solver_iterations);
  }
}

TEST(StepWork, OfASolveIsBoundedHoweverOftenItsContactsChange) {
  Beaten beaten;
  beaten.hair.params.max_iterations = 12;
  int longest = 0;
  for (int n = 0; n < 120; ++n) longest = std::max(longest, beaten.step(n, INFINITY).solver_iterations);
  EXPECT_LE(longest, 12 + 3);  // each round of contacts after the bound takes one
  EXPECT_GE(longest, 12);
}

TEST(StepWork, KeepsToWhatTheStepIsGivenWithNothingInsideTheBodies) {
  Beaten free, bound;
  double dearest = 0, bound_dearest = 0, deepest = 0;
  int cut = 0;
  for (int n = 0; n < 240; ++n) {
    const double units = free.step(n, INFINITY).work_units;
    dearest = std::max(dearest, units);
  }
  const double most = 60.0 * free.hair.mesh.vertexCount();
  for (int n = 0; n < 240; ++n) {
    const sim::StepReport report = bound.step(n, most);
    bound_dearest = std::max(bound_dearest, report.work_units);
    cut += report.solve_cut || report.corrections_cut;
    deepest = std::max(deepest, bound.depth());
    for (const Vec3& p : bound.hair.state.positions) ASSERT_LT(p.norm(), 2);
  }
  std::printf("dearest step %.0f units, bound to %.0f: %.0f, %d of 240 cut, %.3f mm deep\n", dearest, most,
              bound_dearest, cut, 1e3 * deepest);
  EXPECT_GT(dearest, 3 * most);
  EXPECT_LT(bound_dearest, 1.5 * most);  // that nothing is inside comes first
  EXPECT_GT(cut, 0);
  EXPECT_LT(deepest, 1e-6);
}

}  // namespace swept_contact_test
