// Modified PCG with every preconditioner against dense constrained solves, in both precisions.
#include "sim/linear_solver.h"

#include <gtest/gtest.h>

#include "sim/forces/force_model.h"
#include "sim/rotation.h"
#include "tests/test_meshes.h"

namespace {

using sim::BlockMatrix;
using sim::Filter;
using sim::M3;
using sim::Solver;
using sim::V3;
using sim::Vec3;

constexpr double kStep = 1.0 / 60, kDamping = 0.02;

template <class T>
M3<T> plainMatrix(const Eigen::Matrix3d& m) {
  M3<T> out;
  for (int k = 0; k < 9; ++k) out.m[k] = static_cast<T>(m(k / 3, k % 3));
  return out;
}

// A real system matrix, M + h (h + tau) K + h^2 T, of a combed hair mesh.
struct System {
  sim::HairMesh mesh;
  sim::BlockPattern pattern;
  sim::ForceModel<double> model;
  std::vector<Vec3> positions;  // where the matrix was taken

  explicit System(double noise, const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
    test::PatchOptions o;
    o.mixed = o.uneven = true;
    mesh = sim::buildHairMesh(test::combedShape(o));
    pattern = sim::systemPattern(mesh);
    sim::SimParams params = test::tautHair();
    params.sag_free = false;
    model = sim::makeForceModel(mesh, pattern, params);
    test::Random random(11);
    for (const Vec3& p : mesh.shape.positions) positions.push_back(turn * Vec3(p + random.vector(noise)));
  }

  template <class T>
  BlockMatrix<T> matrixAt(const std::vector<Vec3>& x) const {
    BlockMatrix<T> a(&pattern);
    a.setZero();
    sim::Evaluation<T> out;
    out.matrix = &a;
    out.matrix_scale = static_cast<T>(kStep * (kStep + kDamping));
    out.tension_scale = static_cast<T>(kStep * kStep);
    const auto points = test::plain<T>(x);
    sim::evaluate<T>(sim::convertModel<T>(model), points, out);
    for (int i = 0; i < mesh.vertexCount(); ++i) {
      for (int k = 0; k < 9; k += 4) a.diagonal[i].m[k] += static_cast<T>(60 * mesh.vertex_volume[i]);
    }
    return a;
  }
  template <class T>
  sim::Preconditioner<T> preconditioner(const BlockMatrix<T>& a, Solver solver) const {
    sim::Preconditioner<T> p(mesh, pattern);
    if (solver == Solver::kWarped) {
      EXPECT_TRUE(p.setRestMatrix(matrixAt<T>(mesh.shape.positions)));
      const auto points = test::plain<T>(positions);
      for (int k = 0; k < 20; ++k) p.updateRotations(points);  // it follows a large turn over several steps
    }
    p.update(a, solver);
    return p;
  }
};

// What is asked of one solve: right-hand side, first guess (its removed part is the prescribed value), projectors.
struct Problem {
  std::vector<Vec3> rhs, guess;
  std::vector<Eigen::Matrix3d> keep;               // per vertex
  std::vector<sim::VertexConstraint> constraints;  // the same of the vertices that are not roots
};

// Roots are pinned; every other vertex has `removed` directions taken, or a random number of them when it is -1.
Problem makeProblem(const System& system, int removed, test::Random& random) {
  Problem p;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) {
    p.rhs.push_back(random.vector(1e-3));
    p.guess.push_back(random.vector(0.1));
    int count = removed >= 0 ? removed : static_cast<int>(random(0, 3.999));
    if (removed > 0 && random(0, 1) < 0.5) count = 0;  // constrained vertices among free ones
    const Vec3 n = random.direction();
    Eigen::Matrix3d keep = Eigen::Matrix3d::Identity();
    if (count == 1) keep -= n * n.transpose();
    if (count == 2) keep = n * n.transpose();
    if (count == 3 || system.mesh.isRoot(i)) keep.setZero();
    p.keep.push_back(keep);
    if (count == 0 || system.mesh.isRoot(i)) continue;
    const Vec3 side = n.unitOrthogonal();
    sim::VertexConstraint constraint{i, keep, Vec3::Zero(), count, {n, side, n.cross(side)}};
    if (count == 2) constraint.directions = {side, n.cross(side), n};
    p.constraints.push_back(constraint);
  }
  return p;
}

Eigen::VectorXd stackedPoints(const std::vector<Vec3>& points) {
  return test::stacked<double>(test::plain<double>(points));
}

Eigen::MatrixXd filterMatrix(const std::vector<Eigen::Matrix3d>& keep) {
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(3 * keep.size(), 3 * keep.size());
  for (std::size_t i = 0; i < keep.size(); ++i) s.block<3, 3>(3 * i, 3 * i) = keep[i];
  return s;
}

// x = y + S z with y the prescribed part of the guess and S A S z = S (b - A y), by a dense factorization.
Eigen::VectorXd denseSolution(const Eigen::MatrixXd& a, const Problem& p) {
  const Eigen::MatrixXd s = filterMatrix(p.keep);
  const Eigen::MatrixXd removed = Eigen::MatrixXd::Identity(s.rows(), s.cols()) - s;
  const Eigen::VectorXd y = removed * stackedPoints(p.guess);
  const Eigen::MatrixXd reduced = s * a * s + a.norm() * removed;
  return y + s * reduced.ldlt().solve(s * (stackedPoints(p.rhs) - a * y));
}

template <class T>
Filter<T> filterOf(const Problem& p) {
  Filter<T> filter;
  for (std::size_t i = 0; i < p.keep.size(); ++i) {
    if (p.keep[i].isIdentity(0)) continue;
    filter.vertices.push_back(static_cast<int>(i));
    filter.keep.push_back(plainMatrix<T>(p.keep[i]));
  }
  return filter;
}

template <class T>
sim::SolveReport solve(const System& system, const BlockMatrix<T>& a, const Problem& p, Solver solver,
                       const sim::StopRule<T>& stop, Eigen::VectorXd& x, bool corrected = false) {
  sim::Preconditioner<T> preconditioner = system.preconditioner(a, solver);
  if (corrected) preconditioner.setConstraints(p.constraints);
  EXPECT_EQ(preconditioner.kind(), solver) << "the factorization failed";
  sim::SolverScratch<T> scratch;
  scratch.resize(static_cast<int>(p.rhs.size()));
  auto values = test::plain<T>(p.guess);
  const auto rhs = test::plain<T>(p.rhs);
  const auto report = sim::solveModifiedPcg<T>(a, rhs, filterOf<T>(p), preconditioner, stop, scratch, values);
  x = test::stacked<T>(values);
  return report;
}

double energyNorm(const Eigen::MatrixXd& a, const Eigen::VectorXd& x) {
  return std::sqrt(x.dot(a * x));
}

const char* nameOf(Solver solver) {
  constexpr const char* kNames[] = {"paper", "diagonal", "block-jacobi", "column", "incomplete", "warped", "direct"};
  return kNames[static_cast<int>(solver)];
}

struct Way {
  Solver solver;
  bool corrected;  // the factor knows the constraints
};
constexpr Way kWays[] = {{Solver::kPaper, false},  {Solver::kDiagonal, false},   {Solver::kBlockJacobi, false},
                         {Solver::kColumn, false}, {Solver::kIncomplete, false}, {Solver::kWarped, false},
                         {Solver::kWarped, true},  {Solver::kDirect, false},     {Solver::kDirect, true}};

template <class T>
void comparesWithDense(double tolerance, double bound) {
  const System system(0.004);
  const BlockMatrix<T> a = system.matrixAt<T>(system.positions);
  const Eigen::MatrixXd dense = test::dense(a);
  for (const auto& [solver, corrected] : kWays) {
    double worst = 0;
    int most = 0;
    for (const int removed : {0, 1, 2, 3, -1}) {
      test::Random random(20 + removed);
      const Problem p = makeProblem(system, removed, random);
      Eigen::VectorXd x;
      sim::StopRule<T> stop;
      stop.relative = tolerance;
      stop.max_iterations = 5000;
      const sim::SolveReport report = solve<T>(system, a, p, solver, stop, x, corrected);
      const Eigen::VectorXd exact = denseSolution(dense, p);
      const double error = energyNorm(dense, x - exact) / energyNorm(dense, exact);
      EXPECT_TRUE(report.converged) << nameOf(solver) << ", " << removed << " removed";
      EXPECT_LT(error, bound) << nameOf(solver) << ", " << removed << " removed";
      // Prescribed values stay, and what is left over acts in the removed directions alone.
      const Eigen::MatrixXd s = filterMatrix(p.keep);
      const Eigen::VectorXd change = x - stackedPoints(p.guess);
      EXPECT_LT((change - s * change).norm(), 100 * std::numeric_limits<T>::epsilon() * x.norm());
      const Eigen::VectorXd residual = stackedPoints(p.rhs) - dense * x;
      EXPECT_LT((s * residual).norm(), 20 * bound * residual.norm()) << nameOf(solver);
      worst = std::max(worst, error);
      most = std::max(most, report.iterations);
    }
    std::printf("%-12s %-9s worst error %.1e, at most %d iterations\n", nameOf(solver), corrected ? "corrected" : "",
                worst, most);
    EXPECT_TRUE(solver != Solver::kDirect || !corrected || most <= 4) << "the exact inverse of the constrained system";
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

TEST(ModifiedPcg, StopsByEachOfItsRules) {
  const System system(0.004);
  const BlockMatrix<double> a = system.matrixAt<double>(system.positions);
  test::Random random(41);
  const Problem p = makeProblem(system, 0, random);
  Eigen::VectorXd x;
  sim::StopRule<double> stop;
  stop.relative = 1e-10;
  stop.max_iterations = 3;
  auto report = solve<double>(system, a, p, Solver::kBlockJacobi, stop, x);
  EXPECT_EQ(report.iterations, 3);
  EXPECT_FALSE(report.converged);
  stop.max_iterations = 5000;
  stop.relative = 1e-2;
  report = solve<double>(system, a, p, Solver::kBlockJacobi, stop, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.relative_residual, 1e-2);
  EXPECT_GT(report.iterations, 1);

  std::vector<double> inverse_mass_dt;
  for (double volume : system.mesh.vertex_volume) inverse_mass_dt.push_back(1 / (60 * volume * kStep));
  stop.relative = 1e-12;
  stop.inverse_mass_dt = inverse_mass_dt;
  stop.acceleration = 0.5;
  report = solve<double>(system, a, p, Solver::kBlockJacobi, stop, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.residual_acceleration, 0.5);
  EXPECT_GT(report.relative_residual, 1e-12) << "the acceleration stopped it, not the relative residual";
  const Eigen::VectorXd residual = filterMatrix(p.keep) * (stackedPoints(p.rhs) - test::dense(a) * x);
  double largest = 0;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) {
    largest = std::max(largest, residual.segment<3>(3 * i).norm() * inverse_mass_dt[i]);
  }
  EXPECT_NEAR(report.residual_acceleration, largest, 1e-6 * largest);

  // Already solved: no iteration.
  Problem solved = p;
  solved.rhs.assign(p.rhs.size(), Vec3::Zero());
  solved.guess.assign(p.rhs.size(), Vec3::Zero());
  report = solve<double>(system, a, solved, Solver::kBlockJacobi, sim::StopRule<double>{}, x);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(x.norm(), 0);
}

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
