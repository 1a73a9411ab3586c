// Plain evaluation of the elements of any kind, by vertex or in column layout.
//
// k: stiffness, c: condition less its shift, g: its gradient; see force_kind.h.
#pragma once

#include <span>

#include "sim/forces/model.h"
#include "sim/linear/column_matrix.h"

namespace sim {

// Positions and sums by vertex. A pair's block has the larger vertex as its row; `slot`: its number in the pattern.
template <class T>
struct BlockSums {
  std::span<const V3<T>> x;
  const Evaluation<T>& out;

  V3<T> position(int v) const { return x[v]; }
  V3<T> velocity(int v) const { return out.velocities[v]; }
  bool hasVelocities() const { return !out.velocities.empty(); }
  bool hasForce() const { return !out.force.empty(); }
  T dampingShare(int v) const { return out.damping_share[v]; }
  void subtractForce(int v, const V3<T>& f) const { out.force[v] -= f; }
  void addBlock(int row, int column, int slot, const M3<T>& block) const {
    M3<T>& to = row == column ? out.matrix->diagonal[row] : out.matrix->lower[slot];
    for (int i = 0; i < 9; ++i) to.m[i] += block.m[i];
  }
};

// Evaluation in column layout.
template <class T>
struct ColumnEvaluation {
  ColumnField<T>* force = nullptr;    // added
  ColumnMatrix<T>* matrix = nullptr;  // added
  T matrix_scale = 0, tension_scale = 0;
  const ColumnField<T>* velocity = nullptr;
  T damping = 0;
  std::span<const T> damping_share{};  // per entry
};

template <class T>
struct ColumnSums {
  const ColumnLayout& layout;
  const ColumnField<T>& x;
  const ColumnEvaluation<T>& out;

  static V3<T> at(const ColumnField<T>& field, int slot) { return {field.x[slot], field.y[slot], field.z[slot]}; }
  V3<T> position(int v) const { return at(x, layout.slot[v]); }
  V3<T> velocity(int v) const { return at(*out.velocity, layout.slot[v]); }
  bool hasVelocities() const { return out.velocity != nullptr; }
  bool hasForce() const { return out.force != nullptr; }
  T dampingShare(int v) const { return out.damping_share[layout.slot[v]]; }
  void subtractForce(int v, const V3<T>& f) const {
    const int slot = layout.slot[v];
    out.force->x[slot] -= f.x, out.force->y[slot] -= f.y, out.force->z[slot] -= f.z;
  }
  void addBlock(int row, int column, int, const M3<T>& block) const { out.matrix->addBlock(row, column, block); }
};

// The block of vertices p and q of an element.
template <class Kind, class T>
M3<T> hessianBlock(const auto& c, T k, T matrix_scale, int p, int q, const auto& out) {
  const V3<T> a = (matrix_scale * k) * c.g[p], b = c.g[q];
  M3<T> block{{a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z}};
  if constexpr (Kind::kCurved) {
    const M3<T> curvature = Kind::curvature(c, p, q);
    for (int i = 0; i < 9; ++i) block.m[i] += out.tension_scale * k * curvature.m[i];
  }
  return block;
}

// Adds the elements to the sums (BlockSums or ColumnSums) and their energy and dissipation potential to `energy`.
template <class Kind, class T>
void evaluateElements(const Elements<Kind, T>& elements, const auto& sums, T& energy) {
  constexpr int N = Kind::kVertices;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto& v = elements.vertices[e];
    V3<T> x[N];
    for (int p = 0; p < N; ++p) x[p] = sums.position(v[p]);
    const auto c = Kind::condition(x, elements.rest[e], elements.shift[e]);
    if (requires { Kind::kOneSided; } && c.value == 0) continue;
    const T k = elements.stiffness[e];
    T damping = sums.out.damping, matrix_scale = sums.out.matrix_scale;
    if (!sums.out.damping_share.empty()) {
      T share = 0;
      for (const int vertex : v) share += sums.dampingShare(vertex) / N;
      damping *= share;
      matrix_scale = sums.out.tension_scale + share * (matrix_scale - sums.out.tension_scale);
    }
    T pull = k * c.value, dissipation = 0, rate = 0;
    if constexpr (MovingKind<Kind>) {
      rate = Kind::drift(elements.rest[e]);
      if (!sums.hasVelocities()) pull += damping * k * rate;
    }
    if (sums.hasVelocities()) {
      for (int p = 0; p < N; ++p) rate += dot(c.g[p], sums.velocity(v[p]));
      pull += damping * k * rate;
      dissipation = damping * k * rate * rate;
    }
    if (sums.hasForce()) {
      for (int p = 0; p < N; ++p) sums.subtractForce(v[p], pull * c.g[p]);
    }
    energy += T(0.5) * (k * c.value * c.value + dissipation);
    if (!sums.out.matrix) continue;
    int pair = 0;
    for (int p = 0; p < N; ++p) {
      sums.addBlock(v[p], v[p], -1, hessianBlock<Kind>(c, k, matrix_scale, p, p, sums.out));
      for (int q = p + 1; q < N; ++q, ++pair) {
        const int row = v[p] < v[q] ? q : p, column = v[p] < v[q] ? p : q;
        sums.addBlock(v[row], v[column], elements.slots[e][pair],
                      hessianBlock<Kind>(c, k, matrix_scale, row, column, sums.out));
      }
    }
  }
}

}  // namespace sim
