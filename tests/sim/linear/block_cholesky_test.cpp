// Sparse factors and products of block matrices.
#include "sim/linear/block_cholesky.h"

#include "sim/linear/elimination_order.h"
#include "tests/linear_systems.h"

namespace tests {
namespace {

template <class T>
void factorSolves(double bound) {
  const System system(0.004);
  const BlockMatrix<T> a = system.matrixAt<T>(system.positions);
  const int n = system.mesh.vertexCount();
  std::vector<unsigned char> free_vertex;
  for (int i = 0; i < n; ++i) free_vertex.push_back(!system.mesh.isRoot(i));
  sim::BlockCholesky<T> factor;
  factor.analyze(system.pattern, sim::minimumDegreeOrder(system.pattern, free_vertex));
  ASSERT_TRUE(factor.factor(a));
  test::Random random(81);
  std::vector<Vec3> wanted;
  for (int i = 0; i < n; ++i) wanted.push_back(free_vertex[i] ? random.vector(1) : Vec3(0, 0, 0));
  const auto x = test::plain<T>(wanted);
  std::vector<V3<T>> r(n), z(n);
  sim::multiply<T>(a, x, r);
  factor.solve(r, z);
  EXPECT_LT((test::stacked<T>(z) - stackedPoints(wanted)).norm(), bound * stackedPoints(wanted).norm());
}

TEST(BlockCholesky, SolvesTheSystemOfTheFreeVertices) {
  factorSolves<float>(1e-3);
  factorSolves<double>(1e-11);
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

}  // namespace
}  // namespace tests
