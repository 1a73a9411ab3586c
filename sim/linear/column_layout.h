// Where the kernels keep things: columns side by side, layers along the vector lanes.
//
// Neighbouring layers of a column are neighbours in memory, and so are the elements that a root edge or root face has
// in consecutive layers: a kernel handles kLanes layers of one root edge or face at once with plain loads and stores,
// no gathers, no conflicts. Columns are padded to `stride`; elements in the padding have stiffness zero.
#pragma once

#include <span>
#include <vector>

#include "sim/linear/lanes.h"
#include "sim/linear/vector3.h"
#include "sim/mesh/hair_mesh.h"

namespace sim {

struct ColumnLayout {
  static constexpr int kMargin = kLanes;  // entries before and after that loads with a layer offset may touch
  int columns = 0, stride = 0;
  std::vector<int> slot;    // per vertex: its entry in a padded array
  std::vector<int> length;  // per column

  explicit ColumnLayout(const HairMesh& mesh);
  int size() const { return kMargin + columns * stride + kMargin; }
  int first(int column) const { return kMargin + column * stride; }
};

// A vector field on the vertices as three padded arrays, zero in the padding.
template <class T>
struct ColumnField {
  LineVector<T> x, y, z;
  explicit ColumnField(const ColumnLayout& layout) : x(layout.size()), y(layout.size()), z(layout.size()) {}
  void setZero();
  void pack(const ColumnLayout& layout, std::span<const V3<T>> from);
  void unpack(const ColumnLayout& layout, std::span<V3<T>> to) const;
};

template <int kCount = kLanes, class T>
HAIRMESH_INLINE V3<Lanes<T, kCount>> loadAt(const ColumnField<T>& field, int at) {
  return {load<T, kCount>(field.x.data() + at), load<T, kCount>(field.y.data() + at),
          load<T, kCount>(field.z.data() + at)};
}
template <class T>
HAIRMESH_INLINE void addAt(ColumnField<T>& field, int at, const V3<Lanes<T>>& value) {
  addTo<T>(field.x.data() + at, value.x);
  addTo<T>(field.y.data() + at, value.y);
  addTo<T>(field.z.data() + at, value.z);
}

}  // namespace sim
