#include "app/groom/fit/block_matrix.h"

#include <Eigen/LU>
#include <algorithm>

namespace app {

BlockMatrix::BlockMatrix(int rows, const std::vector<MatrixBlock>& blocks, std::vector<std::array<int, 2>> pairs) {
  pairs.reserve(pairs.size() + blocks.size() + static_cast<std::size_t>(rows));
  for (const MatrixBlock& block : blocks) pairs.push_back({block.row, block.column});
  for (int row = 0; row < rows; ++row) pairs.push_back({row, row});
  std::ranges::sort(pairs);
  pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
  first_.push_back(0);
  for (const auto& [row, column] : pairs) {
    columns_.push_back(column);
    if (row == column) first_.push_back(static_cast<int>(columns_.size()));
  }
  values_.assign(columns_.size(), Eigen::Matrix3d::Zero());
  for (const MatrixBlock& block : blocks) at(block.row, block.column) += block.value;
}

Eigen::Matrix3d& BlockMatrix::at(int row, int column) {
  const auto begin = columns_.begin();
  const auto found = std::lower_bound(begin + first_[row], begin + first_[row + 1], column);
  return values_[static_cast<std::size_t>(found - begin)];
}

void BlockMatrix::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& product) const {
  product.setZero(x.size());
  for (int row = 0; row < rows(); ++row) {
    const Eigen::Vector3d here = x.segment<3>(3 * row);
    const int diagonal = first_[row + 1] - 1;
    Eigen::Vector3d sum = values_[static_cast<std::size_t>(diagonal)] * here;
    for (int k = first_[row]; k < diagonal; ++k) {
      const Eigen::Matrix3d& block = values_[static_cast<std::size_t>(k)];
      const int column = 3 * columns_[static_cast<std::size_t>(k)];
      sum += block * x.segment<3>(column);
      product.segment<3>(column) += block.transpose() * here;
    }
    product.segment<3>(3 * row) += sum;
  }
}

bool BlockMatrix::solveFrom(const Eigen::VectorXd& right, double tolerance, int most, Eigen::VectorXd& x) const {
  std::vector<Eigen::Matrix3d> inverse;
  for (int row = 0; row < rows(); ++row)
    inverse.push_back(values_[static_cast<std::size_t>(first_[row + 1] - 1)].inverse());
  const auto precondition = [&](const Eigen::VectorXd& from, Eigen::VectorXd& to) {
    for (int row = 0; row < rows(); ++row)
      to.segment<3>(3 * row) = inverse[static_cast<std::size_t>(row)] * from.segment<3>(3 * row);
  };
  Eigen::VectorXd product(x.size()), preconditioned(x.size());
  multiply(x, product);
  Eigen::VectorXd residual = right - product;
  const double enough = tolerance * tolerance * right.squaredNorm();
  precondition(residual, preconditioned);
  Eigen::VectorXd direction = preconditioned;
  double slope = residual.dot(preconditioned);
  for (int iteration = 0; iteration < most && residual.squaredNorm() > enough; ++iteration) {
    multiply(direction, product);
    const double step = slope / direction.dot(product);
    x += step * direction;
    residual -= step * product;
    precondition(residual, preconditioned);
    const double before = slope;
    slope = residual.dot(preconditioned);
    direction = preconditioned + slope / before * direction;
  }
  return residual.squaredNorm() <= enough;
}

Eigen::SparseMatrix<double> BlockMatrix::sparse() const {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * values_.size());
  for (int row = 0; row < rows(); ++row) {
    for (int k = first_[row]; k < first_[row + 1]; ++k) {
      const int column = columns_[static_cast<std::size_t>(k)];
      if (values_[static_cast<std::size_t>(k)].isZero(0)) continue;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (row == column ? i + 1 : 3); ++j)
          entries.emplace_back(3 * row + i, 3 * column + j, values_[static_cast<std::size_t>(k)](i, j));
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * rows(), 3 * rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace app
