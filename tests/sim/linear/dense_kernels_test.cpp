// The dense kernels of factor and triangular solves against Eigen, for sizes with and without remainders.
#include "sim/linear/dense_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <limits>

#include "tests/test_meshes.h"

namespace {

template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

template <class T>
Matrix<T> randomMatrix(int rows, int columns, test::Random& random) {
  Matrix<T> m(rows, columns);
  for (int k = 0; k < m.size(); ++k) m.data()[k] = static_cast<T>(random(-1, 1));
  return m;
}

// Sums of k products, each rounded; 2 for good measure.
template <class T>
double bound(int k) {
  return 2 * k * std::numeric_limits<T>::epsilon();
}

template <class T>
void addsProducts() {
  test::Random random(5);
  for (const auto& [m, n, k] : {std::array{1, 1, 1}, std::array{3, 3, 3}, std::array{16, 6, 48}, std::array{17, 7, 5},
                                std::array{45, 48, 300}, std::array{100, 10, 513}}) {
    // Within larger matrices, whose other entries stay as they are.
    const Matrix<T> a = randomMatrix<T>(m + 5, k, random),
                    b = randomMatrix<T>(std::max(n, k) + 2, std::max(n, k), random);
    const Matrix<T> before = randomMatrix<T>(m + 3, n + 1, random);
    const int lda = static_cast<int>(a.rows()), ldb = static_cast<int>(b.rows()), ldc = static_cast<int>(before.rows());
    const T s = T(-0.75);
    for (const bool turned : {false, true}) {
      Matrix<T> c = before, wanted = before;
      const Matrix<T> right = turned ? Matrix<T>(b.topLeftCorner(n, k).transpose()) : Matrix<T>(b.topLeftCorner(k, n));
      wanted.topLeftCorner(m, n) += s * a.topLeftCorner(m, k) * right;
      const auto factor = turned ? sim::transposed(b.data(), ldb) : sim::plain(b.data(), ldb);
      sim::addProduct(s, a.data(), lda, factor, m, n, k, c.data(), ldc);
      EXPECT_LT((c - wanted).cwiseAbs().maxCoeff(), bound<T>(k)) << m << " x " << n << " x " << k;
      EXPECT_EQ(c.bottomRows(3), before.bottomRows(3));
      EXPECT_EQ(c.rightCols(1), before.rightCols(1));
    }
  }
}

TEST(DenseKernels, AddProductsOfAllSizes) {
  addsProducts<float>();
  addsProducts<double>();
}

template <class T>
void multipliesTriangles() {
  test::Random random(7);
  for (const int w : {3, 24, 51}) {
    const int h = w + 6;
    const Matrix<T> l = randomMatrix<T>(w, w, random), p = randomMatrix<T>(h, w, random);
    const Matrix<T> x = randomMatrix<T>(w, 1, random), y = randomMatrix<T>(h, 1, random);
    Matrix<T> z = x;
    sim::multiplyLowerInPlace(l.data(), w, z.data());
    EXPECT_LT((z - l.template triangularView<Eigen::Lower>() * x).cwiseAbs().maxCoeff(), bound<T>(w));
    z = x;
    sim::multiplyUpperInPlace(l.data(), w, z.data());
    EXPECT_LT((z - l.template triangularView<Eigen::Lower>().transpose() * x).cwiseAbs().maxCoeff(), bound<T>(w));
    z = y;
    sim::multiplyPanel(p.data(), h, w, x.data(), z.data());
    EXPECT_LT((z - p * x).cwiseAbs().maxCoeff(), bound<T>(w));
    z = x;
    sim::subtractPanelTransposed(p.data(), h, w, y.data(), z.data());
    EXPECT_LT((z - (x - p.transpose() * y)).cwiseAbs().maxCoeff(), bound<T>(h));
  }
}

TEST(DenseKernels, MultiplyTrianglesAndPanels) {
  multipliesTriangles<float>();
  multipliesTriangles<double>();
}

}  // namespace
