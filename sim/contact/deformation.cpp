// u: displacement, r: residual -A^T A u at free vertices, z: r over the degree, d: search direction, q = A^T A d.
#include "sim/contact/deformation.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>

namespace sim {
namespace {

void applyLaplacian(const EdgeLaplacian& laplacian, std::span<const unsigned char> held, std::span<const Vec3> u,
                    std::span<Vec3> out) {
  for (int i = 0; i < laplacian.size(); ++i) {
    if (held[i]) {
      out[i].setZero();
      continue;
    }
    Vec3 sum = laplacian.degree(i) * u[i];
    for (int k = laplacian.row_first[i]; k < laplacian.row_first[i + 1]; ++k) sum -= u[laplacian.neighbours[k]];
    out[i] = sum;
  }
}

double innerProduct(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

// The lower triangle of a symmetric positive definite matrix becomes its Cholesky factor, in place, left-looking:
// unlike Eigen::LLT of a part of a matrix it allocates nothing. False where a pivot is not positive; the rest is then
// as it was.
bool factorLowerInPlace(Eigen::Ref<Eigen::MatrixXd> a) {
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    const double pivot = a(j, j) - a.row(j).head(j).squaredNorm();
    if (!(pivot > 0)) return false;
    a(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < a.rows(); ++i)
      a(i, j) = (a(i, j) - a.row(i).head(j).dot(a.row(j).head(j))) / a(j, j);
  }
  return true;
}

// A backward substitution: the factor, and four right-hand sides a row that the solution replaces.
struct Triangle {
  std::span<const int> first, row;
  std::span<const double> below;
  double* x;
};
// Four sums, so that an addition need not wait for the last one.
HAIRMESH_INLINE void substituteBackward(const Triangle& t) {
  using Row = Lanes<double, 4>;
  const int* row = t.row.data();
  const double* below = t.below.data();
  const auto term = [&](int k) { return below[k] * load<double, 4>(t.x + 4 * static_cast<std::size_t>(row[k])); };
  for (int j = static_cast<int>(t.first.size()) - 2; j >= 0; --j) {
    Row a{}, b{}, c{}, d{};
    int k = t.first[j];
    const int end = t.first[j + 1];
    for (; k + 4 <= end; k += 4) a += term(k), b += term(k + 1), c += term(k + 2), d += term(k + 3);
    for (; k < end; ++k) a += term(k);
    double* const x = t.x + 4 * static_cast<std::size_t>(j);
    store<double, 4>(x, load<double, 4>(x) - ((a + b) + (c + d)));
  }
}
HAIRMESH_CLONES void backward(const Triangle& t) {
  substituteBackward(t);
}

}  // namespace

EdgeLaplacian makeEdgeLaplacian(const HairMesh& mesh) {
  std::vector<std::set<int>> rows(mesh.vertexCount());
  const auto join = [&](int a, int b) { rows[a].insert(b), rows[b].insert(a); };
  for (const Prism& prism : mesh.prisms) {
    for (int k = 0; k < prism.corner_count; ++k) {
      const int next = (k + 1) % prism.corner_count;
      join(prism.v[k], prism.v[next]);
      join(prism.v[prism.corner_count + k], prism.v[prism.corner_count + next]);
      join(prism.v[k], prism.v[prism.corner_count + k]);
    }
  }
  EdgeLaplacian laplacian;
  for (const auto& row : rows) {
    laplacian.neighbours.insert(laplacian.neighbours.end(), row.begin(), row.end());
    laplacian.row_first.push_back(static_cast<int>(laplacian.neighbours.size()));
  }
  return laplacian;
}

int minimizeDeformation(const EdgeLaplacian& laplacian, std::span<const unsigned char> held, double tolerance,
                        MinimizationScratch& scratch, std::span<Vec3> displacement, int most) {
  const int n = laplacian.size();
  bool moved = false;
  for (int i = 0; i < n; ++i) moved = moved || (held[i] && !displacement[i].isZero(0));
  if (!moved) {
    for (int i = 0; i < n; ++i) displacement[i].setZero();
    return 0;
  }
  auto& [r, z, d, q] = scratch;
  for (auto* v : {&r, &z, &d, &q}) v->resize(n);
  applyLaplacian(laplacian, held, displacement, q);
  for (int i = 0; i < n; ++i) {
    r[i] = -q[i];
    d[i] = z[i] = r[i] / std::max(1, laplacian.degree(i));
  }
  double delta = innerProduct(r, z);
  const double goal = tolerance * tolerance * delta;
  int iterations = 0;
  while (delta > goal && iterations < most) {
    applyLaplacian(laplacian, held, d, q);
    const double curvature = innerProduct(d, q);
    if (!(curvature > 0)) break;
    const double alpha = delta / curvature;
    for (int i = 0; i < n; ++i) {
      displacement[i] += alpha * d[i];
      r[i] -= alpha * q[i];
      z[i] = r[i] / std::max(1, laplacian.degree(i));
    }
    const double next = innerProduct(r, z);
    for (int i = 0; i < n; ++i) d[i] = z[i] + (next / delta) * d[i];
    delta = next;
    ++iterations;
  }
  return iterations;
}

DeformationMinimizer::DeformationMinimizer(const HairMesh& mesh)
    : laplacian_(makeEdgeLaplacian(mesh)), row_(mesh.vertexCount(), -1), slot_(mesh.vertexCount(), -1) {
  for (int v = 0; v < mesh.vertexCount(); ++v) root_.push_back(mesh.isRoot(v));
  for (auto* field : {&scratch_.r, &scratch_.z, &scratch_.d, &scratch_.q}) field->resize(mesh.vertexCount());
  factor();
}

void DeformationMinimizer::factor() {
  const int size = laplacian_.size();
  std::vector<int> number(size, -1);
  int free = 0;
  for (int v = 0; v < size; ++v) {
    if (!root_[v]) number[v] = free++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < size; ++v) {
    if (root_[v]) continue;
    entries.emplace_back(number[v], number[v], laplacian_.degree(v));
    for (int k = laplacian_.row_first[v]; k < laplacian_.row_first[v + 1]; ++k) {
      const int other = number[laplacian_.neighbours[k]];
      if (other >= 0) entries.emplace_back(number[v], other, -1);
    }
  }
  Eigen::SparseMatrix<double> matrix(free, free);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  for (int v = 0; v < size; ++v) {
    if (!root_[v]) row_[v] = factor.permutationP().indices()[number[v]];
  }
  const Eigen::SparseMatrix<double> lower = factor.matrixL();
  inverse_d_.resize(free);
  std::vector<int> height(free, 1);
  int highest = 0;
  for (int j = 0; j < free; ++j) {
    inverse_d_[j] = 1 / factor.vectorD()[j];
    first_.push_back(static_cast<int>(row_of_.size()));
    for (Eigen::SparseMatrix<double>::InnerIterator at(lower, j); at; ++at) {
      if (at.row() > j) row_of_.push_back(static_cast<int>(at.row())), below_.push_back(at.value());
    }
    assert(std::is_sorted(row_of_.begin() + first_[j], row_of_.end()));
  }
  first_.push_back(static_cast<int>(row_of_.size()));
  for (int j = free - 1; j >= 0; --j) {
    if (first_[j] < first_[j + 1]) height[j] = height[row_of_[first_[j]]] + 1;
    highest = std::max(highest, height[j]);
  }
  kept_.resize(kMaxHeld);
  for (Kept& kept : kept_) kept.path.reserve(highest), kept.half.reserve(highest);
  held_.reserve(size);
  products_.resize(kMaxHeld, kMaxHeld);
  gram_.resize(kMaxHeld, kMaxHeld);
  pulls_.resize(kMaxHeld, 3);
  work_.resize(free);
  moved_.resize(4 * static_cast<std::size_t>(free));
}

void DeformationMinimizer::computePath(Kept& kept) {
  kept.path.clear();
  kept.half.clear();
  int j = row_[kept.vertex];
  work_[j] = 1;
  for (;;) {
    const double value = work_[j];
    work_[j] = 0;
    kept.path.push_back(j);
    kept.half.push_back(value);
    const int first = first_[j], end = first_[j + 1];
    if (first == end) return;
    for (int k = first; k < end; ++k) work_[row_of_[k]] -= below_[k] * value;
    j = row_of_[first];
  }
}

// Paths from two vertices to the root of the tree are one from where they meet.
double DeformationMinimizer::productOf(const Kept& a, const Kept& b) const {
  double sum = 0;
  for (std::size_t i = a.path.size(), k = b.path.size(); i-- > 0 && k-- > 0 && a.path[i] == b.path[k];)
    sum += a.half[i] * b.half[k] * inverse_d_[a.path[i]];
  return sum;
}

int DeformationMinimizer::findPaths() {
  ++now_;
  for (const int v : held_) {
    if (slot_[v] >= 0) kept_[slot_[v]].used = now_;
  }
  int computed = 0;
  for (const int v : held_) {
    if (slot_[v] >= 0) continue;
    const auto oldest =
        std::min_element(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
    if (oldest->vertex >= 0) slot_[oldest->vertex] = -1;
    oldest->vertex = v, oldest->used = now_;
    const int slot = slot_[v] = static_cast<int>(oldest - kept_.begin());
    computePath(*oldest);
    for (int other = 0; other < kMaxHeld; ++other) {
      if (kept_[other].vertex >= 0) products_(slot, other) = products_(other, slot) = productOf(*oldest, kept_[other]);
    }
    ++computed;
  }
  return computed;
}

int DeformationMinimizer::minimize(std::span<const unsigned char> held, double tolerance, std::span<Vec3> displacement,
                                   int most) {
  const int size = laplacian_.size();
  bool moved = false;
  held_.clear();
  for (int v = 0; v < size; ++v) {
    assert(held[v] || !root_[v]);
    if (!held[v] || root_[v]) continue;
    moved = moved || !displacement[v].isZero(0);
    held_.push_back(v);
  }
  const auto count = static_cast<Eigen::Index>(held_.size());
  const auto iterate = [&] {
    iterated_ = true;
    return minimizeDeformation(laplacian_, held, tolerance, scratch_, displacement, most);
  };
  iterated_ = false;
  if (!moved || count > kMaxHeld) return iterate();
  const int computed = findPaths();
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l <= k; ++l) gram_(k, l) = products_(slot_[held_[k]], slot_[held_[l]]);
    pulls_.row(k) = displacement[held_[k]];
  }
  auto gram = gram_.topLeftCorner(count, count);
  auto pulls = pulls_.topRows(count);
  if (!factorLowerInPlace(gram)) return iterate();
  gram.triangularView<Eigen::Lower>().solveInPlace(pulls);
  gram.triangularView<Eigen::Lower>().transpose().solveInPlace(pulls);
  std::fill(moved_.begin(), moved_.end(), 0);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Kept& kept = kept_[slot_[held_[k]]];
    for (std::size_t i = 0; i < kept.path.size(); ++i) {
      const double half = kept.half[i] * inverse_d_[kept.path[i]];
      for (int c = 0; c < 3; ++c) moved_[4 * kept.path[i] + c] += pulls(k, c) * half;
    }
  }
  backward({first_, row_of_, below_, moved_.data()});
  for (int v = 0; v < size; ++v) {
    if (!held[v]) displacement[v] = Vec3::Map(&moved_[4 * row_[v]]);
  }
  return computed + 1;
}

}  // namespace sim
