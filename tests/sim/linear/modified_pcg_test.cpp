// Modified PCG with every preconditioner against dense constrained solves, in both precisions.
#include "sim/linear/modified_pcg.h"

#include "tests/linear_systems.h"

namespace tests {
namespace modified_pcg_test {

struct Way {
  Kind kind;
  bool known;  // the preconditioner is told of the constraints
};
constexpr Way kWays[] = {{Kind::kDiagonal, false},   {Kind::kBlockJacobi, false}, {Kind::kColumn, false},
                         {Kind::kIncomplete, false}, {Kind::kTwoLevel, false},    {Kind::kTwoLevel, true},
                         {Kind::kDirect, false},     {Kind::kDirect, true}};

template <class T>
void comparesWithDense(double tolerance, double bound) {
  const System system(0.004);
  const BlockMatrix<T> a = system.matrixAt<T>(system.positions);
  const Eigen::MatrixXd dense = test::dense(a);
  for (const auto& [kind, known] : kWays) {
    double worst = 0;
    int most = 0;
    for (const int removed : {0, 1, 2, 3, -1}) {
      test::Random random(20 + removed);
      const Problem p = makeProblem(system, removed, random);
      Eigen::VectorXd x;
      sim::StopRule<T> stop;
      stop.relative = tolerance;
      stop.max_iterations = 5000;
      const sim::SolveReport report = solve<T>(system, a, p, kind, stop, x, known);
      const Eigen::VectorXd exact = denseSolution(dense, p);
      const double error = energyNorm(dense, x - exact) / energyNorm(dense, exact);
      EXPECT_TRUE(report.converged) << nameOf(kind) << ", " << removed << " removed";
      EXPECT_LT(error, bound) << nameOf(kind) << ", " << removed << " removed";
      // Prescribed values stay, and what is left over acts in the removed directions alone.
      const Eigen::MatrixXd s = filterMatrix(p.keep);
      const Eigen::VectorXd change = x - stackedPoints(p.guess);
      EXPECT_LT((change - s * change).norm(), 100 * std::numeric_limits<T>::epsilon() * x.norm());
      const Eigen::VectorXd residual = stackedPoints(p.rhs) - dense * x;
      EXPECT_LT((s * residual).norm(), 20 * bound * residual.norm()) << nameOf(kind);
      worst = std::max(worst, error);
      most = std::max(most, report.iterations);
    }
    std::printf("%-12s %-9s worst error %.1e, at most %d iterations\n", nameOf(kind), known ? "known" : "", worst,
                most);
    EXPECT_TRUE(kind != Kind::kDirect || !known || most <= 4) << "the exact inverse of the constrained system";
  }
}

TEST(ModifiedPcg, AgreesWithADenseConstrainedSolveInDouble) {
  comparesWithDense<double>(1e-13, 1e-9);
}

TEST(ModifiedPcg, AgreesWithADenseConstrainedSolveInFloat) {
  comparesWithDense<float>(1e-6, 2e-4);
}

// The method with one application of the filter left out: r at the start, z, or q. The comparison above must see each
// of them with partial constraints, although whole pins hide them.
double errorWithoutFilterAt(char place, int removed) {
  const System system(0.004);
  const Eigen::MatrixXd a = test::dense(system.matrixAt<double>(system.positions));
  test::Random random(31);
  const Problem p = makeProblem(system, removed, random);
  const Eigen::MatrixXd s = filterMatrix(p.keep);
  const auto filtered = [&](char at, const Eigen::VectorXd& v) -> Eigen::VectorXd { return at == place ? v : s * v; };
  const Eigen::VectorXd inverse = a.diagonal().cwiseInverse();
  Eigen::VectorXd x = stackedPoints(p.guess), r = filtered('r', stackedPoints(p.rhs) - a * x);
  Eigen::VectorXd z = filtered('z', inverse.cwiseProduct(r)), d = z;
  double delta = r.dot(z);
  const double first = delta;
  for (int k = 0; k < 5000 && delta > 1e-26 * first; ++k) {
    const Eigen::VectorXd q = filtered('q', a * d);
    const double alpha = delta / d.dot(q);
    x += alpha * d;
    r -= alpha * q;
    z = filtered('z', inverse.cwiseProduct(r));
    const double next = r.dot(z);
    d = z + (next / delta) * d;
    delta = next;
  }
  const Eigen::VectorXd exact = denseSolution(a, p);
  return energyNorm(a, x - exact) / energyNorm(a, exact);
}

TEST(ModifiedPcg, TheComparisonSeesAFilterLeftOutAtAnyPlace) {
  EXPECT_LT(errorWithoutFilterAt(' ', -1), 1e-9) << "the reference itself is right";
  EXPECT_LT(errorWithoutFilterAt('z', 3), 1e-9) << "with whole pins a missing filter on z stays hidden";
  for (const char place : {'r', 'z', 'q'}) {
    EXPECT_FALSE(errorWithoutFilterAt(place, -1) < 1e-6) << "without the filter on " << place;
  }
}

// A tolerance that single precision cannot reach: the solve ends where its iterations no longer change anything, and
// not before it is as near as one to what it can reach.
TEST(ModifiedPcg, EndsWhereRoundingLeavesNothingToGain) {
  const System system(0.004);
  const BlockMatrix<float> a = system.matrixAt<float>(system.positions);
  const Eigen::MatrixXd dense = test::dense(system.matrixAt<double>(system.positions));
  test::Random random(31);
  const Problem p = makeProblem(system, -1, random);
  const Eigen::VectorXd exact = denseSolution(dense, p);
  for (const Kind kind : {Kind::kDiagonal, Kind::kBlockJacobi, Kind::kColumn}) {
    auto preconditioner = system.preconditioner(a, kind);
    sim::SolverScratch<float> scratch;
    scratch.resize(static_cast<int>(p.rhs.size()));
    auto x = test::plain<float>(p.guess);
    const auto rhs = test::plain<float>(p.rhs);
    sim::StopRule<float> stop;
    stop.relative = 1e-14;
    stop.max_iterations = 100000;
    const auto report =
        sim::solveModifiedPcg<float>(productWith<float>(a), rhs, filterOf<float>(p), preconditioner, stop, scratch, x);
    std::printf("%s: %d iterations\n", nameOf(kind), report.iterations);
    // With exact columns the residual may come out as nothing.
    EXPECT_TRUE(!report.converged || kind == Kind::kColumn);
    EXPECT_LT(report.iterations, 3000) << static_cast<int>(kind);
    EXPECT_LT(energyNorm(dense, test::stacked<float>(x) - exact), 2e-4 * energyNorm(dense, exact));
  }
}

// The ways to go on with a solve must end where a single solve ends.
TEST(ModifiedPcg, GoesOnWhereItStoppedAndAfterConstraintsHaveLoosened) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  const Eigen::MatrixXd dense = test::dense(a);
  test::Random random(43);
  Problem p = makeProblem(system, -1, random);
  auto preconditioner = system.preconditioner(a, Kind::kBlockJacobi);
  sim::SolverScratch<double> scratch;
  scratch.resize(static_cast<int>(p.rhs.size()));
  auto x = test::plain<double>(p.guess);
  auto rhs = test::plain<double>(p.rhs);
  sim::StopRule<double> stop;
  stop.max_iterations = 5000;
  const auto run = [&](double relative, sim::SolveStart start) {
    stop.relative = relative;
    return sim::solveModifiedPcg<double>(productWith<double>(a), rhs, filterOf<double>(p), preconditioner, stop,
                                         scratch, x, start);
  };
  const auto residual = [&] { return Eigen::VectorXd(test::stacked<double>(rhs) - dense * test::stacked<double>(x)); };

  run(1e-2, sim::SolveStart::kFresh);
  const auto gone_on = run(1e-11, sim::SolveStart::kRestart);
  EXPECT_TRUE(gone_on.converged);
  EXPECT_GT(gone_on.iterations, 0);
  EXPECT_LE(run(1e-11, sim::SolveStart::kRestart).iterations, 3) << "the gains that ended the first are forgotten";
  EXPECT_LT((test::stacked<double>(x) - denseSolution(dense, p)).norm(), 1e-7 * denseSolution(dense, p).norm());
  EXPECT_LT((test::stacked<double>(scratch.r) - residual()).norm(), 1e-9 * stackedPoints(p.rhs).norm())
      << "the residual holds the reactions of the constraints";

  // Half the constraints let go and take a force each, which the caller enters into the residual.
  Problem looser = p;
  for (std::size_t i = 0; i < p.keep.size(); i += 2) {
    if (system.mesh.isRoot(static_cast<int>(i)) || p.keep[i].isIdentity(0)) continue;
    looser.keep[i].setIdentity();
    scratch.r[i] -= rhs[i];
    looser.rhs[i] += 0.01 * Vec3::UnitX();
    rhs[i] = test::plain<double>(looser.rhs)[i];
    scratch.r[i] += rhs[i];
  }
  looser.guess.clear();
  for (const auto& value : x) looser.guess.push_back({value.x, value.y, value.z});
  p = looser;
  const auto restarted = run(1e-11, sim::SolveStart::kRestart);
  EXPECT_TRUE(restarted.converged);
  EXPECT_GT(restarted.iterations, 0);
  EXPECT_LT((test::stacked<double>(x) - denseSolution(dense, p)).norm(), 1e-7 * denseSolution(dense, p).norm());
  EXPECT_LT((test::stacked<double>(scratch.r) - residual()).norm(), 1e-9 * stackedPoints(p.rhs).norm());
}

TEST(ModifiedPcg, StopsByEachOfItsRules) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  test::Random random(41);
  const Problem p = makeProblem(system, 0, random);
  Eigen::VectorXd x;
  sim::StopRule<double> stop;
  stop.relative = 1e-10;
  stop.max_iterations = 3;
  auto report = solve<double>(system, a, p, Kind::kBlockJacobi, stop, x);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_FALSE(report.converged);
  stop.max_iterations = 5000;
  stop.relative = 1e-2;
  report = solve<double>(system, a, p, Kind::kBlockJacobi, stop, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.relative_residual, 1e-2);
  EXPECT_GT(report.iterations, 1);

  std::vector<double> inverse_mass_dt;
  for (double volume : system.mesh.vertex_volume) inverse_mass_dt.push_back(1 / (60 * volume * kStep));
  stop.relative = 1e-12;
  stop.inverse_mass_dt = inverse_mass_dt;
  stop.acceleration = 0.5;
  report = solve<double>(system, a, p, Kind::kBlockJacobi, stop, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.residual_acceleration, 0.5);
  EXPECT_GT(report.relative_residual, 1e-12) << "the acceleration stopped it, not the relative residual";
  const Eigen::VectorXd residual = filterMatrix(p.keep) * (stackedPoints(p.rhs) - test::dense(a) * x);
  double largest = 0;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) {
    largest = std::max(largest, residual.segment<3>(3 * i).norm() * inverse_mass_dt[i]);
  }
  EXPECT_NEAR(report.residual_acceleration, largest, 1e-6 * largest);

  // With an exact factor the estimated displacement is the error: the first guess is as good as it says.
  const Problem pinned = makeProblem(system, 3, random);
  stop.acceleration = 0;
  stop.h = kStep;
  Eigen::VectorXd solution;
  solve<double>(system, a, pinned, Kind::kDirect, stop, solution, true);
  Problem near = pinned;
  for (std::size_t i = 0; i < near.guess.size(); ++i) {
    near.guess[i] = solution.segment<3>(3 * i) + near.keep[i] * Vec3(0, 1e-4 / kStep, 0);
  }
  stop.displacement = 1.1e-4;
  EXPECT_EQ(solve<double>(system, a, near, Kind::kDirect, stop, x, true).iterations, 0);
  stop.displacement = 0.9e-4;
  EXPECT_GT(solve<double>(system, a, near, Kind::kDirect, stop, x, true).iterations, 0);

  // Already solved: no iteration.
  Problem solved = p;
  solved.rhs.assign(p.rhs.size(), Vec3::Zero());
  solved.guess.assign(p.rhs.size(), Vec3::Zero());
  report = solve<double>(system, a, solved, Kind::kBlockJacobi, sim::StopRule<double>{}, x);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(x.norm(), 0);
}

// A preconditioner that is symmetric and not positive: blocks of every `period`-th vertex are turned round.
struct TurnedBlocks {
  bench::Preconditioner<double> blocks;
  std::size_t period;
  void apply(std::span<const V3<double>> r, std::span<V3<double>> z) {
    blocks.apply(r, z);
    for (std::size_t i = 0; i < z.size(); i += period) z[i] = -1.0 * z[i];
  }
};

// Rounding leaves factors of very uneven hair indefinite. The residual's square by them may be negative, and says
// nothing about what is left to solve.
TEST(ModifiedPcg, ANegativeSquareIsNoConvergence) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  const Eigen::MatrixXd dense = test::dense(a);
  test::Random random(47);
  const Problem p = makeProblem(system, -1, random);
  const Eigen::VectorXd exact = denseSolution(dense, p);
  for (const std::size_t period : {1u, 2u}) {
    TurnedBlocks turned{system.preconditioner(a, Kind::kBlockJacobi), period};
    sim::SolverScratch<double> scratch;
    scratch.resize(static_cast<int>(p.rhs.size()));
    auto x = test::plain<double>(p.guess);
    sim::StopRule<double> stop;
    stop.relative = 1e-9;
    stop.max_iterations = 5000;
    const auto report = sim::solveModifiedPcg<double>(productWith<double>(a), test::plain<double>(p.rhs),
                                                      filterOf<double>(p), turned, stop, scratch, x);
    EXPECT_TRUE(report.converged) << period;
    EXPECT_GT(report.iterations, 1) << period;
    EXPECT_LT(energyNorm(dense, test::stacked<double>(x) - exact), 1e-6 * energyNorm(dense, exact)) << period;
  }
}

}  // namespace modified_pcg_test
}  // namespace tests
