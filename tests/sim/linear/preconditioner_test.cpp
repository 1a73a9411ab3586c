// The preconditioners and what they are made of: factors, rotations, the matrix.
#include "sim/linear/preconditioner.h"

#include "sim/linear/preconditioner_choice.h"
#include "sim/linear/rotation.h"
#include "sim/linear/vector_kernels.h"
#include "tests/linear_systems.h"

namespace tests {
namespace {

TEST(Preconditioners, DirectFactorSolvesAtOnceAndWarpedFactorFollowsARigidTurn) {
  sim::StopRule<double> stop;
  stop.relative = 1e-10;
  const auto iterations = [&](const System& system, Solver solver) {
    test::Random random(51);
    const Problem p = makeProblem(system, 0, random);
    Eigen::VectorXd x;
    return solve<double>(system, system.matrixAt<double>(system.positions), p, solver, stop, x).iterations;
  };
  EXPECT_LE(iterations(System(0.004), Solver::kDirect), 2);
  EXPECT_LE(iterations(System(0), Solver::kWarped), 2);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.2, Vec3(1, 2, 3).normalized()));
  EXPECT_LE(iterations(System(0, turn), Solver::kWarped), 4) << "the rest matrix turned is the matrix";
  EXPECT_LT(iterations(System(0.001, turn), Solver::kWarped),
            iterations(System(0.001, turn), Solver::kBlockJacobi) / 2);
}

// Symmetric to rounding, whatever 16 bits have done to the entries, and close enough to cost no iteration.
TEST(Preconditioners, TheFactorInSixteenBitsServesAsTheFullOneDoes) {
  const System system(0.0);
  const BlockMatrix<float> a = system.matrixAt<float>(system.positions);
  std::vector<unsigned char> keep(system.mesh.vertexCount());
  for (int i = 0; i < system.mesh.vertexCount(); ++i) keep[i] = !system.mesh.isRoot(i);
  sim::BlockCholesky<float> factor;
  factor.analyze(system.mesh, system.pattern, keep);
  ASSERT_TRUE(factor.factor(a));
  sim::CompactFactor compact;
  compact.assign(factor);
  EXPECT_LT(compact.bytes(), 0.75 * sizeof(float) * factor.values.size());
  const std::size_t n = keep.size();
  test::Random random(51);
  std::vector<V3<float>> r[2], z[2], exact(n);
  for (int side = 0; side < 2; ++side) {
    std::vector<Vec3> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = keep[i] ? random.vector(1) : Vec3(Vec3::Zero());
    r[side] = test::plain<float>(values);
    z[side].resize(n);
    compact.solve(factor, r[side], z[side]);
  }
  const auto inner = [&](const std::vector<V3<float>>& u, const std::vector<V3<float>>& v) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += static_cast<double>(dot(u[i], v[i]));
    return sum;
  };
  const double scale = std::sqrt(inner(r[0], z[0]) * inner(r[1], z[1]));
  EXPECT_NEAR(inner(r[0], z[1]), inner(r[1], z[0]), 1e-4 * scale);
  factor.solve(r[0], exact);
  for (std::size_t i = 0; i < n; ++i) exact[i] -= z[0][i];
  const double wrong = std::sqrt(inner(exact, exact) / inner(z[0], z[0]));
  std::printf("solutions differ by %.1e\n", wrong);
  EXPECT_LT(wrong, 0.05);
  EXPECT_GT(wrong, 1e-6) << "sixteen bits leave a trace: is it the compact factor that was run?";
  // What a panel left behind must not reach the next solve.
  std::vector<V3<float>> broken = r[0], again(n);
  broken[n - 1].x = std::numeric_limits<float>::quiet_NaN();
  compact.solve(factor, broken, again);
  compact.solve(factor, r[0], again);
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(again[i].x, z[0][i].x);

  const System bent(0.004);
  const BlockMatrix<float> b = bent.matrixAt<float>(bent.positions);
  const Problem p = makeProblem(bent, 0, random);
  int iterations[2];
  for (const bool small : {false, true}) {
    sim::Preconditioner<float> preconditioner = bent.preconditioner(b, Solver::kWarped);
    ASSERT_TRUE(preconditioner.setRestMatrix(bent.matrixAt<float>(bent.mesh.shape.positions), small));
    sim::SolverScratch<float> scratch;
    scratch.resize(static_cast<int>(n));
    auto x = test::plain<float>(p.guess);
    const auto rhs = test::plain<float>(p.rhs);
    const Filter<float> filter = filterOf<float>(p);
    sim::StopRule<float> stop;
    iterations[small] = sim::solveModifiedPcg<float>(b, rhs, filter, preconditioner, stop, scratch, x).iterations;
  }
  EXPECT_LE(iterations[1], iterations[0] + 1);
}

template <class T>
void batchIsManySolves(double bound) {
  const System system(0.004);
  const BlockMatrix<T> a = system.matrixAt<T>(system.positions);
  std::vector<unsigned char> free_vertex;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) free_vertex.push_back(!system.mesh.isRoot(i));
  sim::BlockCholesky<T> factor;
  factor.analyze(system.mesh, system.pattern, free_vertex);
  ASSERT_TRUE(factor.factor(a));
  constexpr int kSides = sim::BlockCholesky<T>::kBatch;
  test::Random random(81);
  std::vector<T> batch(3 * factor.order.size() * kSides, T(0));
  std::vector<std::vector<V3<T>>> sides(kSides, std::vector<V3<T>>(system.mesh.vertexCount(), V3<T>{0, 0, 0}));
  std::vector<int> touched;
  for (int k = 0; k < kSides; ++k) {
    const int position = static_cast<int>(random(0, static_cast<double>(factor.order.size()) - 1e-6));
    touched.push_back(position);
    const Vec3 f = random.vector(1);
    sides[k][factor.order[position]] = {static_cast<T>(f.x()), static_cast<T>(f.y()), static_cast<T>(f.z())};
    for (int axis = 0; axis < 3; ++axis) batch[(3 * position + axis) * kSides + k] = static_cast<T>(f[axis]);
  }
  factor.solveBatch(batch, touched);
  for (int k = 0; k < kSides; ++k) {
    std::vector<V3<T>> z(system.mesh.vertexCount());
    factor.solve(sides[k], z);
    double largest = 0, difference = 0;
    for (std::size_t position = 0; position < factor.order.size(); ++position) {
      const V3<T>& one = z[factor.order[position]];
      const T* many = batch.data() + 3 * position * kSides + k;
      const V3<T> gap = one - V3<T>{many[0], many[kSides], many[2 * kSides]};
      largest = std::max(largest, std::sqrt(static_cast<double>(dot(one, one))));
      difference = std::max(difference, std::sqrt(static_cast<double>(dot(gap, gap))));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(difference, bound * largest) << k;
  }
}

TEST(Preconditioners, ABatchOfRightHandSidesIsAsManySolves) {
  batchIsManySolves<float>(1e-4);
  batchIsManySolves<double>(1e-12);
}

// More contacts than are answered for: the rest is left to the filter, and the solution stays right.
TEST(Preconditioners, ContactsBeyondTheCorrectedOnesAreLeftToTheFilter) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  const Eigen::MatrixXd dense = test::dense(a);
  sim::Preconditioner<double> preconditioner = system.preconditioner(a, Solver::kWarped);
  sim::SolverScratch<double> scratch;
  scratch.resize(system.mesh.vertexCount());
  for (const int seed : {61, 62}) {  // the second set takes the places of the first
    test::Random random(seed);
    const Problem p = makeProblem(system, -1, random);
    std::vector<sim::VertexConstraint> many = p.constraints;
    EXPECT_FALSE(preconditioner.setConstraints(many, 1)) << "one batch is not enough";
    preconditioner.setConstraints(many);
    auto x = test::plain<double>(p.guess);
    sim::StopRule<double> stop;
    stop.relative = 1e-12;
    stop.max_iterations = 5000;
    const auto rhs = test::plain<double>(p.rhs);
    const Filter<double> filter = filterOf<double>(p);
    const auto report = sim::solveModifiedPcg<double>(a, rhs, filter, preconditioner, stop, scratch, x);
    EXPECT_TRUE(report.converged);
    std::vector<Vec3> points(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) points[i] = Vec3(x[i].x, x[i].y, x[i].z);
    const Eigen::VectorXd exact = denseSolution(dense, p);
    EXPECT_LT(energyNorm(dense, stackedPoints(points) - exact) / energyNorm(dense, exact), 1e-8);
  }
}

// Total cost over solves of which the two kinds cost `factor` and `blocks`.
double costOfSolves(sim::PreconditionerChoice& choice, int solves, double factor, double blocks) {
  double total = 0;
  for (int k = 0; k < solves; ++k) {
    const auto plan = choice.begin();
    const double wanted = plan.cheap ? blocks : factor;
    const bool overrun = wanted > plan.budget;
    const double cost = overrun ? plan.budget + (plan.cheap ? factor : blocks) : wanted;
    choice.end(plan, cost, overrun);
    total += cost;
  }
  return total;
}

TEST(PreconditionerChoice, IsNeverMuchDearerThanTheBetterOfTheTwo) {
  for (const auto& [factor, blocks] : {std::pair{10.0, 100.0},
                                       {60.0, 100.0},
                                       {100.0, 60.0},
                                       {400.0, 50.0},
                                       {100.0, 1000.0},
                                       {50.0, 400.0},
                                       {500.0, 500.0}}) {
    sim::PreconditionerChoice choice;
    costOfSolves(choice, 50, factor, blocks);
    EXPECT_LT(costOfSolves(choice, 500, factor, blocks), 1.15 * 500 * std::min(factor, blocks))
        << factor << " " << blocks;
  }
}

TEST(PreconditionerChoice, FollowsTheMotionAndTriesNothingWhereSolvesAreCheap) {
  sim::PreconditionerChoice choice;
  EXPECT_EQ(costOfSolves(choice, 100, 10, 5), 1000) << "the factor serves, and nothing else is tried";
  costOfSolves(choice, 100, 500, 50);
  EXPECT_TRUE(choice.cheap);
  costOfSolves(choice, 200, 20, 50);
  EXPECT_FALSE(choice.cheap);
}

TEST(BlockMatrix, ProductIsTheDenseOne) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  test::Random random(61);
  std::vector<Vec3> x;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) x.push_back(random.vector(1));
  const auto points = test::plain<double>(x);
  std::vector<V3<double>> y(points.size());
  sim::multiply<double>(a, points, y);
  const Eigen::VectorXd expected = test::dense(a) * stackedPoints(x);
  EXPECT_LT((test::stacked<double>(y) - expected).norm(), 1e-13 * expected.norm());
  EXPECT_EQ(system.pattern.find(1, 0) >= 0, true);
  EXPECT_EQ(system.pattern.find(system.pattern.size - 1, 0), -1);
}

TEST(VertexRotations, AreTheTurnOfARigidMotionAndStayRotationsInEveryState) {
  const System system(0);
  test::Random random(71);
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::Quaterniond turn = random.rotation();
    std::vector<Vec3> x;
    for (const Vec3& p : system.mesh.shape.positions) x.push_back(turn * p + Vec3(1, 2, 3));
    sim::VertexRotations<double> rotations(system.mesh);
    for (int k = 0; k < 60; ++k) rotations.update(test::plain<double>(x));
    for (const auto& r : rotations.matrices) {
      EXPECT_LT((test::eigen(r) - turn.toRotationMatrix()).norm(), 1e-6);
    }
    for (const double scale : {0.0, 1e-9, 0.3}) {  // collapsed, nearly so, random
      for (Vec3& p : x) p = random.vector(scale);
      rotations.update(test::plain<double>(x));
      for (const auto& r : rotations.matrices) {
        EXPECT_LT((test::eigen(r) * test::eigen(r).transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
        EXPECT_GT(test::eigen(r).determinant(), 0);
      }
    }
  }
}

}  // namespace
}  // namespace tests
