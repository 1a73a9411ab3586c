#include "sim/linear/two_level.h"

#include <algorithm>

namespace sim {

template <class T>
TwoLevel<T>::TwoLevel(const HairMesh& mesh)
    : layout_(mesh),
      pattern_(mesh, layout_),
      layers_(mesh, layout_, pattern_),
      columns_(mesh, layout_, pattern_),
      coarse_(mesh, layout_, pattern_),
      field_(layout_) {
  held_.reserve(mesh.vertexCount());
}

// Returns whether the factors know these constraints already; if not, `held_` is of them from now on.
template <class T>
bool TwoLevel<T>::noteHeld(std::span<const VertexConstraint> constraints) {
  if (std::ranges::equal(constraints, held_, [](const VertexConstraint& c, const auto& known) {
        return c.vertex == known.first && c.removed == known.second;
      })) {
    return true;
  }
  held_.clear();
  for (const VertexConstraint& c : constraints) held_.emplace_back(c.vertex, c.removed);
  return false;
}

template <class T>
void TwoLevel<T>::update(const ColumnMatrix<T>& a, std::span<const V3<T>> x,
                         std::span<const VertexConstraint> constraints) {
  factors_age_.kept = noteHeld(constraints) && factors_age_.serves();
  if (!factors_age_.kept) {
    layers_.factor(a, constraints);
    columns_.factor(a, constraints);
  }
  coarse_age_.kept = has_coarse_ && coarse_age_.serves() && coarse_.unknown(constraints) <= kMaxUnknown;
  if (!coarse_age_.kept) has_coarse_ = coarse_.make(a, x, constraints);
}

template <class T>
void TwoLevel<T>::count(int iterations) {
  factors_age_.count(iterations);
  coarse_age_.count(iterations);
}

template <class T>
void TwoLevel<T>::forget() {
  factors_age_.forget();
  coarse_age_.forget();
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
