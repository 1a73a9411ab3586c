// Vectors and the system matrix in column layout: columns side by side, layers along the vector lanes.
//
// Neighbouring layers of a column are neighbours in memory, and so are the elements that a root edge or root face has
// in consecutive layers: a kernel handles kLanes layers of one root edge or face at once with plain loads and stores,
// no gathers, no conflicts. Columns are padded to `stride`; elements in the padding have stiffness zero.
//
// The matrix is symmetric, of 3x3 blocks, kept as block diagonals of column pairs.
// The blocks that couple layer l of column a with layer l + offset of column b, for all l, stand side by side, one
// array a component, so that assembly and product are plain vector code along the layers.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "sim/linear/block_matrix.h"
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

// One block diagonal. For a == b the offset is not negative; offset 0 is the symmetric diagonal (six components:
// xx, xy, xz, yy, yz, zz), all others have nine, row-major.
struct BlockDiagonal {
  int a, b, offset;
  int row, column;     // entries of (a, 0) and (b, offset) in a padded array
  std::size_t values;  // start of its components, `stride` apart
  int lanes;           // entries to be walked, a multiple of kLanes; from there to the stride values are zero
  bool symmetric() const { return a == b && offset == 0; }
};

// Where an element's pair of vertices adds its block: the values' start for layer 0, whether it is transposed there.
struct BlockPlace {
  int at = -1;
  bool transposed = false;
};

struct ColumnPattern {
  int stride = 0;
  std::vector<BlockDiagonal> diagonals;  // the columns' own offset 0 first, in column order
  std::size_t value_count = 0;

  ColumnPattern(const HairMesh& mesh, const ColumnLayout& layout);
  // Place of the block of (column p, layer l + dp) and (column q, layer l + dq) as a function of l: element l of the
  // arrays at `at`. The pair must be coupled by some element.
  BlockPlace place(int p, int dp, int q, int dq) const;

 private:
  std::map<std::array<int, 3>, int> number_;  // (a, b, offset) -> diagonal
};

template <class T>
struct ColumnMatrix {
  const ColumnLayout* layout;
  const ColumnPattern* pattern;
  LineVector<T> values;

  ColumnMatrix(const ColumnLayout& l, const ColumnPattern& p) : layout(&l), pattern(&p), values(p.value_count) {}
  void setZero();
  // Adds scale * mass to the diagonal (mass per vertex, in vertex order).
  void addMass(T scale, std::span<const T> mass);
  // Adds the block of vertices v and w to the matrix, which is symmetric; some element of the mesh couples them. For v
  // == w the block is symmetric itself.
  void addBlock(int v, int w, const M3<T>& block);
  // The 3x3 block of vertex v's diagonal.
  M3<T> diagonalBlock(int v) const;
};

// Scratch of a product: its vectors in the layout.
template <class T>
struct ColumnProduct {
  ColumnField<T> x, y;
  explicit ColumnProduct(const ColumnLayout& layout) : x(layout), y(layout) {}
};
// y = A x; vectors in vertex order.
template <class T>
void multiply(const ColumnMatrix<T>& a, ColumnProduct<T>& scratch, std::span<const V3<T>> x, std::span<V3<T>> y);

}  // namespace sim
