// Factors and products of block matrices.
#include "sim/linear/envelope_cholesky.h"
#include "tests/block_product.h"
#include "tests/linear_systems.h"

namespace tests {
namespace block_matrix_test {

template <class T>
void factorSolves(double bound) {
  const System system(0.004);
  const BlockMatrix<T> a = system.matrixAt<T>(system.positions);
  std::vector<int> first(3 * system.pattern.size);
  for (std::size_t row = 0; row < first.size(); ++row) {
    const int i = static_cast<int>(row) / 3, k = system.pattern.row_first[i];
    first[row] = k < system.pattern.row_first[i + 1] ? 3 * system.pattern.columns[k] : 3 * i;
  }
  const Eigen::Matrix<double, -1, -1> whole = test::dense(a);
  sim::EnvelopeCholesky<T> factor;
  factor.analyze(first);
  const auto fill = [&] {
    factor.setZero();
    for (int row = 0; row < whole.rows(); ++row) {
      for (int column = first[row]; column <= row; ++column)
        factor.at(row, column) = static_cast<T>(whole(row, column));
    }
  };
  fill();
  ASSERT_TRUE(factor.factor());
  test::Random random(81);
  std::vector<Vec3> wanted;
  for (int i = 0; i < system.mesh.vertexCount(); ++i) wanted.push_back(random.vector(1));
  const auto x = test::plain<T>(wanted);
  std::vector<V3<T>> z(x.size());
  sim::multiply<T>(a, x, z);
  factor.solve(&z[0].x);
  EXPECT_LT((test::stacked<T>(z) - stackedPoints(wanted)).norm(), bound * stackedPoints(wanted).norm());
  fill();
  factor.at(9, 9) *= -1;
  EXPECT_FALSE(factor.factor()) << "a pivot is not positive";
}

TEST(EnvelopeCholesky, SolvesAndRefusesWhatIsNotPositive) {
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

}  // namespace block_matrix_test
}  // namespace tests
