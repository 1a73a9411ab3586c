#include "sim/linear/two_level.h"

#include <algorithm>

namespace sim {

template <class T>
TwoLevel<T>::TwoLevel(const HairMesh& mesh)
    : layout_(mesh),
      columns_(mesh, layout_),
      layers_(mesh, layout_, columns_),
      strands_(mesh, layout_, columns_),
      patches_(mesh, layout_, columns_),
      field_(layout_) {
  masked_.reserve(mesh.vertexCount());
}

// Returns whether the factors know these constraints already; if not, they are taken to from now on.
template <class T>
bool TwoLevel<T>::noteConstraints(std::span<const VertexConstraint> constraints) {
  if (std::ranges::equal(constraints, masked_, [](const VertexConstraint& c, const auto& known) {
        return c.vertex == known.first && c.removed == known.second;
      })) {
    return true;
  }
  masked_.clear();
  for (const VertexConstraint& c : constraints) masked_.emplace_back(c.vertex, c.removed);
  return false;
}

template <class T>
void TwoLevel<T>::apply(std::span<const V3<T>> r, std::span<V3<T>> z) {
  field_.pack(layout_, r);
  if (patched_) patches_.solve(field_);
  layers_.solve(field_);
  if (patched_) patches_.add(field_);
  field_.unpack(layout_, z);
  strands_.addSolution(r, kStrandWeight, z);
}

template struct TwoLevel<float>;
template struct TwoLevel<double>;

}  // namespace sim
