// Cholesky factors of small dense matrices that change every step.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace sim {

// The lower triangle of a symmetric positive definite matrix becomes its Cholesky factor, in place, left-looking:
// unlike Eigen::LLT of a part of a matrix it allocates nothing. False where a pivot is not positive; the rest is then
// as it was.
inline bool factorLowerInPlace(Eigen::Ref<Eigen::MatrixXd> a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double pivot = a(j, j) - a.row(j).head(j).squaredNorm();
    if (!(pivot > 0)) return false;
    a(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < a.rows(); ++i)
      a(i, j) = (a(i, j) - a.row(i).head(j).dot(a.row(j).head(j))) / a(j, j);
  }
  return true;
}

}  // namespace sim
