// u: displacement, r: residual -A^T A u at free vertices, z: r over the degree, d: search direction, q = A^T A d.
#include "sim/deformation.h"

#include <algorithm>
#include <cassert>
#include <set>

#include "sim/small_cholesky.h"

namespace sim {
namespace {

constexpr int kMostIterations = 1000;

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
                        MinimizationScratch& scratch, std::span<Vec3> displacement) {
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
  while (delta > goal && iterations < kMostIterations) {
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
  factor_.compute(matrix);
  for (int v = 0; v < size; ++v) {
    if (!root_[v]) row_[v] = factor_.permutationP().indices()[number[v]];
  }
  kept_.resize(kMostHeld);
  held_.reserve(size);
  answers_.resize(free, kMostHeld);
  gram_.resize(kMostHeld, kMostHeld);
  pulls_.resize(kMostHeld, 3);
  moved_.resize(free, 3);
}

int DeformationMinimizer::findAnswers() {
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
    *oldest = {v, now_};
    slot_[v] = static_cast<int>(oldest - kept_.begin());
    auto answer = answers_.col(slot_[v]);
    answer.setZero();
    answer[row_[v]] = 1;
    factor_.matrixL().solveInPlace(answer);
    answer.array() /= factor_.vectorD().array();
    factor_.matrixU().solveInPlace(answer);
    ++computed;
  }
  return computed;
}

int DeformationMinimizer::minimize(std::span<const unsigned char> held, double tolerance,
                                   std::span<Vec3> displacement) {
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
  if (!moved || count > kMostHeld) return minimizeDeformation(laplacian_, held, tolerance, scratch_, displacement);
  const int computed = findAnswers();
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l <= k; ++l) gram_(k, l) = answers_(row_[held_[k]], slot_[held_[l]]);
    pulls_.row(k) = displacement[held_[k]];
  }
  auto gram = gram_.topLeftCorner(count, count);
  auto pulls = pulls_.topRows(count);
  if (!factorLowerInPlace(gram)) return minimizeDeformation(laplacian_, held, tolerance, scratch_, displacement);
  gram.triangularView<Eigen::Lower>().solveInPlace(pulls);
  gram.triangularView<Eigen::Lower>().transpose().solveInPlace(pulls);
  moved_.setZero();
  for (Eigen::Index k = 0; k < count; ++k) {
    for (int c = 0; c < 3; ++c) moved_.col(c) += pulls(k, c) * answers_.col(slot_[held_[k]]);
  }
  for (int v = 0; v < size; ++v) {
    if (!held[v]) displacement[v] = moved_.row(row_[v]);
  }
  return computed + 1;
}

}  // namespace sim
