// The numeric factorization of a BlockCholesky, in pieces small enough to be spread over steps.
//
// A supernode goes through five stages, all but the first a few columns at a time: its front is assembled from the
// matrix and its children's updates; the triangle on the diagonal is factored; inverted; the rows below are multiplied
// by the inverse; and what they subtract from the supernodes above is left on the stack. The pieces are the same
// however they are spread, so that the factor is the same to the bit.
//
// w: the supernode's width, h: its height, both in scalars.
#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "sim/linear/block_cholesky.h"
#include "sim/linear/dense_kernels.h"

namespace sim {
namespace {

constexpr int kColumns = 48;  // of a piece; below it the dense products lose their speed

template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using Panel = Eigen::Map<Matrix<T>, 0, Eigen::OuterStride<>>;

template <class T>
Panel<T> panel(T* values, int rows, int columns) {
  return {values, rows, columns, Eigen::OuterStride<>(rows)};
}

double product(double a, double b, double c) {
  return 2 * a * b * c;
}

}  // namespace

template <class T>
bool BlockCholesky<T>::assembleFront(const BlockMatrix<T>& a, double& spent) {
  const Supernode& s = supernodes[at_.supernode];
  const int w = s.width(), h = s.height(), size = w + h;
  for (int k = 0; k < s.columns; ++k) local_[s.first + k] = 3 * k;
  for (int k = 0; k < s.rows; ++k) local_[row_index[s.rows_first + k]] = w + 3 * k;
  auto front = panel(front_.data(), size, size);
  front.template triangularView<Eigen::Lower>().setZero();
  for (int c = s.first; c < s.first + s.columns; ++c) {
    const int column = local_[c];
    const M3<T>& d = a.diagonal[order[c]];
    for (int k = 0; k < 9; ++k) front(column + k / 3, column + k % 3) += d.m[k];
    for (int k = entries_first_[c]; k < entries_first_[c + 1]; ++k) {
      const Entry& entry = entries_[k];
      const M3<T>& b = a.lower[entry.block];
      const int r = local_[entry.row];
      for (int e = 0; e < 9; ++e) {
        front(r + (entry.turned ? e % 3 : e / 3), column + (entry.turned ? e / 3 : e % 3)) += b.m[e];
      }
    }
  }
  while (!pending_.empty() && supernodes[pending_.back().supernode].parent == at_.supernode) {
    const Supernode& child = supernodes[pending_.back().supernode];
    const int ch = child.height();
    const auto update = panel(stack_.data() + pending_.back().at, ch, ch);
    for (int j = 0; j < child.rows; ++j) {
      const int column = local_[row_index[child.rows_first + j]];
      for (int i = j; i < child.rows; ++i) {
        const int row = local_[row_index[child.rows_first + i]];
        front.template block<3, 3>(row, column) += update.template block<3, 3>(3 * i, 3 * j);
      }
    }
    spent += static_cast<double>(ch) * ch;
    stack_size_ = pending_.back().at;
    pending_.pop_back();
  }
  spent += static_cast<double>(size) * size;
  return true;
}

// Right-looking: the columns' own triangle, the rows of the diagonal block below it, what these subtract from the rest.
template <class T>
bool BlockCholesky<T>::factorDiagonal(double& spent) {
  const Supernode& s = supernodes[at_.supernode];
  const int size = s.width() + s.height(), j = at_.column, b = std::min(kColumns, s.width() - j);
  const int rest = s.width() - j - b;
  auto front = panel(front_.data(), size, size);
  auto own = front.block(j, j, b, b);
  if (Eigen::internal::llt_inplace<T, Eigen::Lower>::blocked(own) >= 0) return false;
  if (rest > 0) {
    auto below = front.block(j + b, j, rest, b);
    own.template triangularView<Eigen::Lower>().transpose().template solveInPlace<Eigen::OnTheRight>(below);
    for (int k = 0; k < rest; k += kColumns) {
      const int first = j + b + k;
      addProduct(T(-1), &front(first, j), size, transposed(&front(first, j), size), rest - k,
                 std::min(kColumns, rest - k), b, &front(first, first), size);
    }
  }
  spent += product(b, b, b) / 6 + product(rest, b, b) / 2 + product(rest, rest, b) / 2;
  at_.column += b;
  return true;
}

template <class T>
bool BlockCholesky<T>::invertDiagonal(double& spent) {
  const Supernode& s = supernodes[at_.supernode];
  const int w = s.width(), size = w + s.height(), j = at_.column, b = std::min(kColumns, w - j);
  auto front = panel(front_.data(), size, size);
  auto inverse = panel(values.data() + s.values, w, w);
  inverse.middleCols(j, b).setZero();
  inverse.block(j, j, b, b).setIdentity();
  // Forward substitution, some rows at a time: what is known of the columns comes off them first.
  for (int i = j; i < w; i += kColumns) {
    const int rows = std::min(kColumns, w - i);
    auto at = inverse.block(i, j, rows, b);
    if (i > j) addProduct(T(-1), &front(i, j), size, plain(&inverse(j, j), w), rows, b, i - j, at.data(), w);
    front.block(i, i, rows, rows).template triangularView<Eigen::Lower>().solveInPlace(at);
  }
  spent += product(w - j, w - j, b) / 2;
  at_.column += b;
  return true;
}

template <class T>
bool BlockCholesky<T>::computeRows(double& spent) {
  const Supernode& s = supernodes[at_.supernode];
  const int w = s.width(), h = s.height(), size = w + h, j = at_.column, b = std::min(kColumns, w - j);
  auto front = panel(front_.data(), size, size);
  auto inverse = panel(values.data() + s.values, w, w);
  auto rows = panel(values.data() + s.values + static_cast<std::size_t>(w) * w, h, w);
  rows.middleCols(j, b).setZero();
  // Row k of the inverse ends at column k.
  addProduct(T(1), &front(w, 0), size, transposed(&inverse(j, 0), w), h, b, j + b, &rows(0, j), h);
  spent += product(h, j + b, b);
  at_.column += b;
  return true;
}

template <class T>
bool BlockCholesky<T>::computeUpdate(double& spent) {
  const Supernode& s = supernodes[at_.supernode];
  const int w = s.width(), h = s.height(), size = w + h, j = at_.column, b = std::min(kColumns, h - j);
  const auto front = panel(front_.data(), size, size);
  auto rows = panel(values.data() + s.values + static_cast<std::size_t>(w) * w, h, w);
  auto update = panel(stack_.data() + stack_size_, h, h).block(j, j, h - j, b);
  update = front.block(w + j, w + j, h - j, b);
  addProduct(T(-1), &rows(j, 0), h, transposed(&rows(j, 0), h), h - j, b, w, update.data(), h);
  spent += product(h - j, b, w);
  at_.column += b;
  if (at_.column == h) {
    pending_.push_back({at_.supernode, stack_size_});
    stack_size_ += static_cast<std::size_t>(h) * h;
  }
  return true;
}

template <class T>
void BlockCholesky<T>::beginFactor() {
  values.resize(value_count_);
  front_.resize(static_cast<std::size_t>(largest_front_) * largest_front_);
  stack_.resize(deepest_stack_);
  stack_size_ = 0;
  pending_.clear();
  at_ = {};
}

template <class T>
bool BlockCholesky<T>::workColumn(double& spent) {
  switch (at_.stage) {
    case 1:
      return factorDiagonal(spent);
    case 2:
      return invertDiagonal(spent);
    case 3:
      return computeRows(spent);
    default:
      return computeUpdate(spent);
  }
}

template <class T>
typename BlockCholesky<T>::Progress BlockCholesky<T>::continueFactor(const BlockMatrix<T>& a, double operations) {
  double spent = 0;
  for (; at_.supernode < static_cast<int>(supernodes.size()); at_ = {at_.supernode + 1, 0, 0}) {
    const Supernode& s = supernodes[at_.supernode];
    if (at_.stage == 0) {
      assembleFront(a, spent);
      at_.stage = 1;
    }
    for (; at_.stage <= 4; at_ = {at_.supernode, at_.stage + 1, 0}) {
      const bool below = at_.stage > 2;
      const int columns = below && s.rows == 0 ? 0 : at_.stage == 4 ? s.height() : s.width();
      while (at_.column < columns) {
        if (spent >= operations) return Progress::kMore;
        if (!workColumn(spent)) return Progress::kFailed;
      }
    }
  }
  return Progress::kDone;
}

template <class T>
bool BlockCholesky<T>::factor(const BlockMatrix<T>& a) {
  beginFactor();
  return continueFactor(a, std::numeric_limits<double>::infinity()) == Progress::kDone;
}

template <class T>
void BlockCholesky<T>::release() {
  for (auto* array : {&values, &front_, &stack_}) std::vector<T>().swap(*array);
}

template <class T>
double BlockCholesky<T>::factorOperations() const {
  double sum = 0;
  for (const Supernode& s : supernodes) {
    const double w = s.width(), h = s.height();
    sum += product(w, w, w) / 3 + product(h, w, w) / 2 + product(h, h, w) / 2 + 2 * (w + h) * (w + h);
  }
  return sum;
}

template bool BlockCholesky<float>::factor(const BlockMatrix<float>&);
template bool BlockCholesky<double>::factor(const BlockMatrix<double>&);
template void BlockCholesky<float>::beginFactor();
template void BlockCholesky<double>::beginFactor();
template BlockCholesky<float>::Progress BlockCholesky<float>::continueFactor(const BlockMatrix<float>&, double);
template BlockCholesky<double>::Progress BlockCholesky<double>::continueFactor(const BlockMatrix<double>&, double);
template void BlockCholesky<float>::release();
template void BlockCholesky<double>::release();
template double BlockCholesky<float>::factorOperations() const;
template double BlockCholesky<double>::factorOperations() const;

}  // namespace sim
