#include "sim/column_matrix.h"

#include <algorithm>
#include <set>

namespace sim {

ColumnLayout::ColumnLayout(const HairMesh& mesh) : columns(mesh.columnCount()) {
  int longest = 0;
  for (int c = 0; c < columns; ++c) {
    length.push_back(mesh.shape.columnLength(c));
    longest = std::max(longest, length.back());
  }
  stride = (longest + kLanes - 1) / kLanes * kLanes;
  for (int v = 0; v < mesh.vertexCount(); ++v) slot.push_back(first(mesh.column_of[v]) + mesh.layer_of[v]);
}

template <class T>
void ColumnField<T>::setZero() {
  for (auto* array : {&x, &y, &z}) std::fill(array->begin(), array->end(), T(0));
}

template <class T>
void ColumnField<T>::pack(const ColumnLayout& layout, std::span<const V3<T>> from) {
  for (std::size_t v = 0; v < from.size(); ++v) {
    const int at = layout.slot[v];
    x[at] = from[v].x, y[at] = from[v].y, z[at] = from[v].z;
  }
}

template <class T>
void ColumnField<T>::unpack(const ColumnLayout& layout, std::span<V3<T>> to) const {
  for (std::size_t v = 0; v < to.size(); ++v) {
    const int at = layout.slot[v];
    to[v] = {x[at], y[at], z[at]};
  }
}

ColumnPattern::ColumnPattern(const HairMesh& mesh, const ColumnLayout& layout) : stride(layout.stride) {
  // Wanted block diagonals: own ones to offset 2; over root edges offsets -2 to 2 (walls and hinges); over a quad's
  // diagonals offset 0 (corner tetrahedra).
  std::set<std::array<int, 3>> wanted;
  const auto want = [&](int a, int b, int reach) {
    for (int offset = -reach; offset <= reach; ++offset) wanted.insert({std::min(a, b), std::max(a, b), offset});
  };
  for (const RootFace& face : mesh.shape.root_faces) {
    const int n = face.corner_count;
    for (int k = 0; k < n; ++k) want(face.columns[k], face.columns[(k + 1) % n], 2);
    for (int k = 0; n == 4 && k < 2; ++k) want(face.columns[k], face.columns[k + 2], 0);
  }
  const auto add = [&](int a, int b, int offset) {
    BlockDiagonal d{a, b, offset, layout.first(a), layout.first(b) + offset, value_count, 0};
    const int entries = std::min(layout.length[a], layout.length[b] - offset);  // l runs from max(0, -offset) to here
    d.lanes = std::max(0, entries + kLanes - 1) / kLanes * kLanes;
    number_[{a, b, offset}] = static_cast<int>(diagonals.size());
    diagonals.push_back(d);
    value_count += static_cast<std::size_t>(d.symmetric() ? 6 : 9) * stride;
  };
  for (int c = 0; c < layout.columns; ++c) add(c, c, 0);
  for (const int offset : {1, 2}) {
    for (int c = 0; c < layout.columns; ++c) add(c, c, offset);
  }
  // By offset first: what one diagonal has stored, the next must not load again shifted by a lane or two, or the
  // processor waits for the store (a tenth of the product's time).
  for (int offset = -2; offset <= 2; ++offset) {
    for (const auto& [a, b, own] : wanted) {
      if (own == offset) add(a, b, offset);
    }
  }
  value_count += 2 * kLanes;  // stores of elements in the padding reach past the last array
}

BlockPlace ColumnPattern::place(int p, int dp, int q, int dq) const {
  const bool swap = p > q || (p == q && dp > dq);
  const int a = swap ? q : p, da = swap ? dq : dp, b = swap ? p : q, db = swap ? dp : dq;
  const auto it = number_.find({a, b, db - da});
  if (it == number_.end()) return {};
  return {static_cast<int>(diagonals[it->second].values) + da, swap};
}

template <class T>
void ColumnMatrix<T>::setZero() {
  std::fill(values.begin(), values.end(), T(0));
}

template <class T>
void ColumnMatrix<T>::addMass(T scale, std::span<const T> mass) {
  for (std::size_t v = 0; v < mass.size(); ++v) {
    const int entry = layout->slot[v] - ColumnLayout::kMargin;
    T* at = values.data() + pattern->diagonals[entry / layout->stride].values + entry % layout->stride;
    for (const int component : {0, 3, 5}) at[component * layout->stride] += scale * mass[v];
  }
}

template <class T>
M3<T> ColumnMatrix<T>::diagonalBlock(int v) const {
  const int entry = layout->slot[v] - ColumnLayout::kMargin, s = layout->stride;
  const T* at = values.data() + pattern->diagonals[entry / s].values + entry % s;
  return {at[0], at[s], at[2 * s], at[s], at[3 * s], at[4 * s], at[2 * s], at[4 * s], at[5 * s]};
}

template <class T>
void ColumnMatrix<T>::toBlocks(const HairMesh& mesh, BlockMatrix<T>& to) const {
  to.setZero();
  for (int v = 0; v < mesh.vertexCount(); ++v) to.diagonal[v] = diagonalBlock(v);
  for (const BlockDiagonal& d : pattern->diagonals) {
    if (d.symmetric()) continue;
    for (int l = std::max(0, -d.offset); l < layout->length[d.a] && l + d.offset < layout->length[d.b]; ++l) {
      const int i = mesh.shape.column_first[d.a] + l, j = mesh.shape.column_first[d.b] + l + d.offset;
      const int block = to.pattern->find(std::max(i, j), std::min(i, j));
      if (block < 0) continue;
      M3<T> m;
      for (int k = 0; k < 9; ++k) m.m[i > j ? k : 3 * (k % 3) + k / 3] = values[d.values + k * layout->stride + l];
      to.lower[block] = m;
    }
  }
}

namespace {

template <class T>
HAIRMESH_INLINE void product(const ColumnPattern& pattern, const T* values, const ColumnField<T>& x,
                             ColumnField<T>& y) {
  const std::size_t s = pattern.stride;
  for (const BlockDiagonal& d : pattern.diagonals) {
    for (int l = 0; l < d.lanes; l += kLanes) {
      const T* at = values + d.values + l;
      const V3<Lanes<T>> xb = loadAt(x, d.column + l);
      if (d.symmetric()) {
        const Lanes<T> xx = load<T>(at), xy = load<T>(at + s), xz = load<T>(at + 2 * s), yy = load<T>(at + 3 * s),
                       yz = load<T>(at + 4 * s), zz = load<T>(at + 5 * s);
        addAt(y, d.row + l,
              V3<Lanes<T>>{xx * xb.x + xy * xb.y + xz * xb.z, xy * xb.x + yy * xb.y + yz * xb.z,
                           xz * xb.x + yz * xb.y + zz * xb.z});
        continue;
      }
      const V3<Lanes<T>> xa = loadAt(x, d.row + l);
      Lanes<T> m[9];
      for (int k = 0; k < 9; ++k) m[k] = load<T>(at + k * s);
      addAt(y, d.row + l,
            V3<Lanes<T>>{m[0] * xb.x + m[1] * xb.y + m[2] * xb.z, m[3] * xb.x + m[4] * xb.y + m[5] * xb.z,
                         m[6] * xb.x + m[7] * xb.y + m[8] * xb.z});
      addAt(y, d.column + l,
            V3<Lanes<T>>{m[0] * xa.x + m[3] * xa.y + m[6] * xa.z, m[1] * xa.x + m[4] * xa.y + m[7] * xa.z,
                         m[2] * xa.x + m[5] * xa.y + m[8] * xa.z});
    }
  }
}

HAIRMESH_CLONES void runProduct(const ColumnPattern& p, const float* v, const ColumnField<float>& x,
                                ColumnField<float>& y) {
  product(p, v, x, y);
}
HAIRMESH_CLONES void runProduct(const ColumnPattern& p, const double* v, const ColumnField<double>& x,
                                ColumnField<double>& y) {
  product(p, v, x, y);
}

}  // namespace

template <class T>
void multiply(const ColumnMatrix<T>& a, ColumnProduct<T>& scratch, std::span<const V3<T>> x, std::span<V3<T>> y) {
  scratch.x.pack(*a.layout, x);
  scratch.y.setZero();
  runProduct(*a.pattern, a.values.data(), scratch.x, scratch.y);
  scratch.y.unpack(*a.layout, y);
}

template struct ColumnField<float>;
template struct ColumnField<double>;
template struct ColumnMatrix<float>;
template struct ColumnMatrix<double>;
template void multiply(const ColumnMatrix<float>&, ColumnProduct<float>&, std::span<const V3<float>>,
                       std::span<V3<float>>);
template void multiply(const ColumnMatrix<double>&, ColumnProduct<double>&, std::span<const V3<double>>,
                       std::span<V3<double>>);

}  // namespace sim
