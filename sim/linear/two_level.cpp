#include "sim/linear/two_level.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace sim {
namespace {

bool serves(const PartMemory& part, double cost, int oldest, const MatrixTerms& terms) {
  return !part.input.positions.empty() && part.age < oldest && part.lost < cost && part.input.terms == terms;
}

void count(bool kept, int iterations, PartMemory& part) {
  if (!kept) part.age = 0, part.lost = 0, part.fresh = iterations;
  ++part.age;
  part.lost += std::max(0, iterations - part.fresh);
}

bool same(const PartMemory::Input& a, const PartMemory::Input& b) {
  const auto equal = [](const VertexConstraint& c, const VertexConstraint& d) {
    return c.vertex == d.vertex && c.removed == d.removed && c.directions == d.directions;
  };
  return a.positions.size() == b.positions.size() && a.terms == b.terms &&
         std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3)) == 0 &&
         std::ranges::equal(a.constraints, b.constraints, equal);
}

// Directions held in one and not in the other, where the vertices of `now` are among those of `was`, in their order.
int heldOtherwise(std::span<const VertexConstraint> was, std::span<const VertexConstraint> now) {
  int directions = 0;
  for (auto next = now.begin(); const VertexConstraint& c : was) {
    const bool held = next != now.end() && next->vertex == c.vertex;
    directions += std::abs(c.removed - (held ? (next++)->removed : 0));
  }
  return directions;
}

template <class T>
void note(std::span<const V3<T>> x, std::span<const VertexConstraint> constraints, const MatrixTerms& terms,
          PartMemory::Input& input) {
  input.positions.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) input.positions[i] = Vec3(x[i].x, x[i].y, x[i].z);
  input.constraints.assign(constraints.begin(), constraints.end());
  input.terms = terms;
}

}  // namespace

template <class T>
TwoLevel<T>::TwoLevel(const HairMesh& mesh)
    : layout_(mesh),
      pattern_(mesh, layout_),
      layers_(mesh, layout_, pattern_),
      columns_(mesh, layout_, pattern_),
      coarse_(mesh, layout_, pattern_),
      field_(layout_),
      x_(mesh.vertexCount()) {
  for (auto* input : {&factors_of_, &coarse_of_}) input->constraints.reserve(mesh.vertexCount());
}

template <class T>
void TwoLevel<T>::makeFactors(const ColumnMatrix<T>& a, const PartMemory::Input& input) {
  layers_.factor(a, input.constraints);
  columns_.factor(a, input.constraints);
  factors_of_ = input;
  ++made_factors;
}

template <class T>
void TwoLevel<T>::makeCoarse(const ColumnMatrix<T>& a, std::span<const V3<T>> x, const PartMemory::Input& input) {
  has_coarse_ = coarse_.make(a, x, input.constraints);
  coarse_of_ = input;
  ++made_coarse;
}

template <class T>
void TwoLevel<T>::recall(const Assemble& assemble) {
  const auto place = [&](const PartMemory::Input& input) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Vec3& p = input.positions[i];
      x_[i] = {static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z())};
    }
  };
  const PartMemory::Input &factors = memory.factors.input, &coarse = memory.coarse.input;
  if (!factors.positions.empty() && !same(factors, factors_of_)) {
    place(factors);
    makeFactors(assemble(x_, factors.terms), factors);
  }
  if (!coarse.positions.empty() && !same(coarse, coarse_of_)) {
    place(coarse);
    makeCoarse(assemble(x_, coarse.terms), x_, coarse);
  }
}

template <class T>
void TwoLevel<T>::update(const ColumnMatrix<T>& a, std::span<const V3<T>> x,
                         std::span<const VertexConstraint> constraints, const MatrixTerms& terms) {
  PartMemory::Input &factors = memory.factors.input, &coarse = memory.coarse.input;
  factors_kept_ = factors.constraints.size() == constraints.size() &&
                  heldOtherwise(factors.constraints, constraints) == 0 &&
                  serves(memory.factors, kFactorsCost, kFactorsServe, terms);
  if (!factors_kept_) {
    note(x, constraints, terms, factors);
    makeFactors(a, factors);
  }
  coarse_kept_ = serves(memory.coarse, kCoarseCost, kCoarseServes, terms) && has_coarse_ &&
                 coarse_.unknown(constraints) <= kMaxUnknown;
  if (!coarse_kept_) {
    note(x, constraints, terms, coarse);
    makeCoarse(a, x, coarse);
  }
}

template <class T>
void TwoLevel<T>::follow(const ColumnMatrix<T>& a, std::span<const V3<T>> x,
                         std::span<const VertexConstraint> constraints, const MatrixTerms& terms) {
  PartMemory::Input& factors = memory.factors.input;
  const int held = heldOtherwise(factors.constraints, {});
  if (heldOtherwise(factors.constraints, constraints) <= std::max(kMaxOther, held / 2)) return;
  note(x, constraints, terms, factors);
  makeFactors(a, factors);
  factors_kept_ = false;
}

template <class T>
void TwoLevel<T>::count(int iterations) {
  sim::count(factors_kept_, iterations, memory.factors);
  sim::count(coarse_kept_, iterations, memory.coarse);
}

template <class T>
void TwoLevel<T>::drop() {
  factors_of_.positions.clear();
  coarse_of_.positions.clear();
}

template <class T>
void TwoLevel<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  field_.pack(layout_, r);
  if (has_coarse_) coarse_.solve(field_);
  layers_.solve(field_);
  if (has_coarse_) coarse_.add(field_);
  field_.unpack(layout_, z);
  columns_.addSolution(r, kColumnWeight, z);
}

template struct TwoLevel<float>;
template struct TwoLevel<double>;

}  // namespace sim
