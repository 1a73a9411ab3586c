// Symmetric matrices of 3 x 3 blocks, a block for two vertices, and how they are solved.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

namespace app {

// A block of the lower half or the diagonal: row >= column.
struct MatrixBlock {
  int row = 0, column = 0;
  Eigen::Matrix3d value;
};

// The lower half with the diagonal, row by row, of a positive definite matrix of 3 `rows` unknowns.
class BlockMatrix {
 public:
  // With the sum of these blocks, zero where none is. `pairs`: (row, column) of others that are added to later.
  BlockMatrix(int rows, const std::vector<MatrixBlock>& blocks, std::vector<std::array<int, 2>> pairs);

  int rows() const { return static_cast<int>(first_.size()) - 1; }
  // The block of row >= column that the constructor was told of.
  Eigen::Matrix3d& at(int row, int column);
  Eigen::Matrix3d& diagonal(int row) { return values_[static_cast<std::size_t>(first_[row + 1] - 1)]; }

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& product) const;
  // By conjugate gradients from x, until the residual is `tolerance` of the right-hand side. False where that takes
  // more than `most` iterations.
  bool solveFrom(const Eigen::VectorXd& right, double tolerance, int most, Eigen::VectorXd& x) const;
  // The lower half without blocks of zeros, for a factorization.
  Eigen::SparseMatrix<double> sparse() const;

 private:
  std::vector<int> first_;  // per row, of columns_ and values_; its last one is the diagonal
  std::vector<int> columns_;
  std::vector<Eigen::Matrix3d> values_;
};

}  // namespace app
