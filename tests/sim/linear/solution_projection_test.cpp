// The start of a solve from what earlier steps did, and the solve that stays conjugate to it.
#include "sim/linear/solution_projection.h"

#include <gtest/gtest.h>

#include "sim/linear/vector_kernels.h"
#include "tests/block_product.h"
#include "tests/linear_systems.h"

namespace solution_projection_test {

using namespace tests;

struct Start {
  System system{0.002};
  BlockMatrix<double> matrix = system.matrixAt<double>(system.positions);
  Eigen::MatrixXd dense = test::dense(matrix);
  Problem problem;
  Eigen::VectorXd wanted;        // the solution
  std::vector<V3<double>> x, r;  // the guess and its residual
  std::vector<Vec3> error;       // of the guess
  sim::SolutionProjection<double> guess{system.mesh.vertexCount()};

  explicit Start(int removed) {
    test::Random random(17);
    problem = makeProblem(system, removed, random);
    wanted = denseSolution(dense, problem);
    x = test::plain<double>(problem.guess);
    const Eigen::VectorXd e = wanted - stackedPoints(problem.guess);
    for (std::size_t i = 0; i < x.size(); ++i) error.push_back(e.segment<3>(3 * i));
    setResidual();
  }
  void setResidual() {
    r.resize(x.size());
    sim::multiply<double>(matrix, x, r);
    const auto b = test::plain<double>(problem.rhs);
    for (std::size_t i = 0; i < x.size(); ++i) r[i] = b[i] - r[i];
  }
  void record(const std::vector<Vec3>& change) {
    guess.record([&](std::size_t i) { return V3<double>{change[i].x(), change[i].y(), change[i].z()}; });
  }
  double improve() { return guess.improve(productWith<double>(matrix), filterOf<double>(problem), x, r); }
  void shorten() { guess.shorten(productWith<double>(matrix), filterOf<double>(problem), x, r); }
  double distance() const { return energyNorm(dense, test::stacked<double>(x) - wanted); }
};

std::vector<Vec3> noise(std::size_t n, double size, unsigned seed) {
  test::Random random(seed);
  std::vector<Vec3> values;
  for (std::size_t i = 0; i < n; ++i) values.push_back(random.vector(size));
  return values;
}

TEST(SolutionProjection, FindsWhatIsACombinationOfTheChangesAndSaysHowFarItWas) {
  for (const int removed : {0, 2}) {
    Start start(removed);
    std::vector<Vec3> one = noise(start.x.size(), 0.1, 3), two;
    // Within the free directions, as changes under the same constraints are.
    for (std::size_t i = 0; i < one.size(); ++i) one[i] = start.problem.keep[i] * one[i];
    for (std::size_t i = 0; i < one.size(); ++i) two.push_back(0.5 * start.error[i] - 2 * one[i]);
    start.record(one);
    start.record(two);
    const double before = start.distance(), gained = start.improve();
    EXPECT_LT(start.distance(), 1e-6 * before);
    EXPECT_NEAR(gained, before * before, 1e-6 * before * before);
  }
}

TEST(SolutionProjection, IsNeverFartherKeepsConstraintsAndTheResidual) {
  Start start(2);
  start.record(noise(start.x.size(), 1, 5));
  start.record(noise(start.x.size(), 1e-3, 6));
  start.record(noise(start.x.size(), 1, 7));
  const double before = start.distance(), gained = start.improve(), after = start.distance();
  EXPECT_LE(after, before);
  EXPECT_NEAR(after * after, before * before - gained, 1e-9 * before * before);
  EXPECT_EQ(start.guess.deflation().size(), static_cast<std::size_t>(sim::SolutionProjection<double>::kChanges));
  std::vector<V3<double>> product(start.x.size());
  sim::multiply<double>(start.matrix, start.x, product);
  for (std::size_t i = 0; i < product.size(); ++i) {
    const Vec3 residual = start.problem.rhs[i] - test::eigen(product[i]);
    EXPECT_LT((residual - test::eigen(start.r[i])).norm(), 1e-12);
    const Eigen::Matrix3d removed = Eigen::Matrix3d::Identity() - start.problem.keep[i];
    EXPECT_LT((removed * (test::eigen(start.x[i]) - start.problem.guess[i])).norm(), 1e-12) << "vertex " << i;
  }
}

TEST(SolutionProjection, AStartFartherOffThanNoneIsShortened) {
  for (const int removed : {0, 2}) {
    for (const double times : {-1.0, 0.1, 30.0}) {
      Start start(removed);
      const Eigen::VectorXd x = test::stacked<double>(start.x), free = filterMatrix(start.problem.keep) * x;
      const Eigen::VectorXd none = x - free, far_off = none + times * free;
      for (std::size_t i = 0; i < start.x.size(); ++i)
        start.x[i] = {far_off[3 * i], far_off[3 * i + 1], far_off[3 * i + 2]};
      start.setResidual();
      const double far = start.distance();
      start.shorten();
      // Between where it was and none there lies the least.
      EXPECT_LT(start.distance(), far * (1 - 1e-3));
      EXPECT_LE(start.distance(), energyNorm(start.dense, none - start.wanted) * (1 + 1e-12));
    }
  }
}

TEST(SolutionProjection, NothingRecordedOrNothingMovedLeavesTheStart) {
  Start start(0);
  const auto x = test::stacked<double>(start.x);
  EXPECT_EQ(start.improve(), 0);
  start.record(std::vector<Vec3>(start.x.size(), Vec3::Zero()));
  EXPECT_EQ(start.improve(), 0);
  EXPECT_TRUE(start.guess.deflation().empty());
  start.record(std::vector<Vec3>(start.x.size(), Vec3::Constant(std::nan(""))));
  EXPECT_EQ(start.improve(), 0) << "a value that is not finite is nothing to go by";
  EXPECT_EQ(test::stacked<double>(start.x), x);
}

TEST(SolutionProjection, AChangeThatOnlyRepeatsAnotherIsLeftOut) {
  Start start(1);
  std::vector<Vec3> change = noise(start.x.size(), 0.1, 4);
  start.record(change);
  for (Vec3& c : change) c *= 1.7;
  start.record(change);
  start.improve();
  EXPECT_EQ(start.guess.deflation().size(), 1u);
}

// The error is the slowest mode there is; the change has it in it, hidden under a part that iterations find at once. So
// the start comes hardly nearer, but the deflated solve gets the slow part for nothing.
TEST(SolutionProjection, DeflatedIterationsFindTheSameAnswerSooner) {
  int iterations[2];
  for (const bool deflated : {false, true}) {
    Start start(1);
    const Eigen::MatrixXd s = filterMatrix(start.problem.keep);
    const Eigen::MatrixXd free = s * start.dense * s;
    const Eigen::MatrixXd removed = Eigen::MatrixXd::Identity(s.rows(), s.cols()) - s;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(free + start.dense.norm() * removed);
    const Eigen::VectorXd slow = modes.eigenvectors().col(0), fast = modes.eigenvectors().col(slow.size() / 2);
    start.wanted = stackedPoints(start.problem.guess) + slow;
    const Eigen::VectorXd b_all = start.dense * start.wanted, r_all = start.dense * slow;
    const double ratio = std::sqrt(modes.eigenvalues()[0] / modes.eigenvalues()[slow.size() / 2]);
    std::vector<Vec3> change;
    for (std::size_t i = 0; i < start.x.size(); ++i) {
      start.problem.rhs[i] = b_all.segment<3>(3 * i);
      start.r[i] = test::plain<double>(Vec3(r_all.segment<3>(3 * i)));
      change.push_back(slow.segment<3>(3 * i) + 3 * ratio * fast.segment<3>(3 * i));
    }
    start.record(change);
    sim::SolverScratch<double> scratch;
    scratch.resize(static_cast<int>(start.x.size()));
    const auto b = test::plain<double>(start.problem.rhs);
    const auto filter = filterOf<double>(start.problem);
    sim::StopRule<double> stop;
    stop.head_start = start.improve();
    stop.relative = 0.1;
    scratch.r = start.r;
    if (deflated) scratch.deflation = start.guess.deflation();
    auto preconditioner = start.system.preconditioner(start.matrix, Kind::kBlockJacobi);
    const double before = energyNorm(start.dense, start.wanted - stackedPoints(start.problem.guess));
    const sim::SolveReport report =
        sim::solveModifiedPcg<double>(productWith<double>(start.matrix), b, filter, preconditioner, stop, scratch,
                                      start.x, sim::SolveStart::kPrepared);
    EXPECT_TRUE(report.converged);
    EXPECT_LT(start.distance(), 0.2 * before);
    for (const auto& one : scratch.deflation) {
      EXPECT_LT(std::abs(sim::innerProduct<double>(one.x, scratch.r)), 1e-6 * before * std::sqrt(one.energy));
    }
    iterations[deflated] = report.iterations;
  }
  std::printf("iterations %d, deflated %d\n", iterations[0], iterations[1]);
  EXPECT_LT(4 * iterations[1], 3 * iterations[0]);
}

// Rounding leaves something in the residual along the directions that the iterations are conjugate to. Steps that
// counted it blew up once a solve in single precision went on to a millionth: 2 cm off within three steps.
TEST(SolutionProjection, SolvesInSinglePrecisionGoAsFarAsTheyAreAsked) {
  const auto positions = [](sim::Precision precision) {
    sim::SimParams params;
    params.precision = precision;
    params.tolerance = precision == sim::Precision::kDouble ? 1e-12 : 1e-6;
    params.acceleration_tolerance = params.displacement_tolerance = 0;
    params.max_iterations = 2000;
    test::Hair hair(test::combedShape(test::mixedPatch(9, 0.2)), params);
    test::Random random(11);
    for (int i = 0; i < hair.mesh.vertexCount(); ++i) {
      if (!hair.mesh.isRoot(i)) hair.state.velocities[i] = Vec3(0.2, 0, -1) + random.vector(0.3);
    }
    for (int n = 0; n < 6; ++n) hair.step(1.0 / 60);
    return hair.state.positions;
  };
  const auto exact = positions(sim::Precision::kDouble), x = positions(sim::Precision::kFloat);
  double off = 0;
  for (std::size_t i = 0; i < x.size(); ++i) off = std::max(off, (x[i] - exact[i]).norm());
  EXPECT_LT(off, 3e-5);
}

}  // namespace solution_projection_test
