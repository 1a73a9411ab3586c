// Matrices of blocks against dense ones.
#include "app/groom/fit/block_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

namespace block_matrix_test {

// Blocks of a chain with some links across, diagonally dominant, and the dense matrix that they are.
struct Sample {
  std::vector<app::MatrixBlock> blocks;
  Eigen::MatrixXd dense;
};

Sample sampleOf(int rows) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> any(-1, 1);
  Sample sample{{}, Eigen::MatrixXd::Zero(3 * rows, 3 * rows)};
  const auto add = [&](int row, int column, const Eigen::Matrix3d& value) {
    sample.blocks.push_back({row, column, value});
    sample.dense.block<3, 3>(3 * row, 3 * column) += value;
    if (row != column) sample.dense.block<3, 3>(3 * column, 3 * row) += value.transpose();
  };
  for (int row = 0; row < rows; ++row) {
    add(row, row, 9 * Eigen::Matrix3d::Identity());
    for (const int back : {1, 7}) {
      if (row < back) continue;
      add(row, row - back, Eigen::Matrix3d::NullaryExpr([&] { return any(engine); }));
    }
  }
  add(rows - 1, rows - 2, Eigen::Matrix3d::Identity());  // a second time
  return sample;
}

TEST(BlockMatrix, IsTheDenseMatrixOfItsBlocks) {
  const Sample sample = sampleOf(20);
  app::BlockMatrix matrix(20, sample.blocks, {{19, 0}});
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(60, -1, 2);
  Eigen::VectorXd product;
  matrix.multiply(x, product);
  EXPECT_LT((product - sample.dense * x).norm(), 1e-12);
  const Eigen::MatrixXd lower = Eigen::MatrixXd(matrix.sparse());
  EXPECT_EQ(lower, Eigen::MatrixXd(sample.dense.triangularView<Eigen::Lower>()));
  EXPECT_EQ(matrix.at(19, 0), Eigen::Matrix3d::Zero());
  matrix.at(19, 0)(1, 2) = 5;
  matrix.multiply(x, product);
  const Eigen::VectorXd more = product - sample.dense * x;
  EXPECT_NEAR(more[58], 5 * x[2], 1e-12);
  EXPECT_NEAR(more[2], 5 * x[58], 1e-12);
  EXPECT_NEAR(more.norm(), 5 * std::hypot(x[2], x[58]), 1e-12);
}

TEST(BlockMatrix, IsSolvedAsTheDenseOne) {
  const Sample sample = sampleOf(50);
  const app::BlockMatrix matrix(50, sample.blocks, {});
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(150, 3, -1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(150);
  EXPECT_TRUE(matrix.solveFrom(right, 1e-9, 200, x));
  EXPECT_LT((x - sample.dense.llt().solve(right)).norm(), 1e-7 * x.norm());
  Eigen::VectorXd short_of = Eigen::VectorXd::Zero(150);
  EXPECT_FALSE(matrix.solveFrom(right, 1e-9, 2, short_of));
}

}  // namespace block_matrix_test
