#include "sim/linear/column_matrix.h"

#include <algorithm>
#include <cassert>
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

namespace {

// The pairs in an order in which those near to one another have no column in common.
std::vector<std::array<int, 2>> apart(std::vector<std::array<int, 2>> pairs) {
  constexpr std::size_t kNear = 6;
  std::vector<std::array<int, 2>> ordered;
  const auto clash = [&](const std::array<int, 2>& p) {
    for (std::size_t k = ordered.size() - std::min(kNear, ordered.size()); k < ordered.size(); ++k) {
      const auto& q = ordered[k];
      if (p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) return true;
    }
    return false;
  };
  while (!pairs.empty()) {
    auto next = std::find_if_not(pairs.begin(), pairs.end(), clash);
    if (next == pairs.end()) next = pairs.begin();
    ordered.push_back(*next);
    pairs.erase(next);
  }
  return ordered;
}

}  // namespace

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
    std::vector<std::array<int, 2>> pairs;
    for (const auto& [a, b, own] : wanted) {
      if (own == offset) pairs.push_back({a, b});
    }
    for (const auto& [a, b] : apart(pairs)) add(a, b, offset);
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
void ColumnMatrix<T>::addBlock(int v, int w, const M3<T>& block) {
  const int s = layout->stride, p = layout->slot[v] - ColumnLayout::kMargin,
            q = layout->slot[w] - ColumnLayout::kMargin;
  const BlockPlace place = pattern->place(p / s, p % s, q / s, q % s);
  assert(place.at >= 0);
  T* at = values.data() + place.at;
  if (v == w) {
    constexpr int kUpper[6] = {0, 1, 2, 4, 5, 8};
    for (int k = 0; k < 6; ++k) at[k * s] += block.m[kUpper[k]];
    return;
  }
  for (int k = 0; k < 9; ++k) at[k * s] += block.m[place.transposed ? 3 * (k % 3) + k / 3 : k];
}

template <class T>
M3<T> ColumnMatrix<T>::diagonalBlock(int v) const {
  const int entry = layout->slot[v] - ColumnLayout::kMargin, s = layout->stride;
  const T* at = values.data() + pattern->diagonals[entry / s].values + entry % s;
  return {at[0], at[s], at[2 * s], at[s], at[3 * s], at[4 * s], at[2 * s], at[4 * s], at[5 * s]};
}

namespace {

// A field as one address and the ways from there to the other components: few registers, and nothing that the compiler
// would fetch anew after every store.
template <class T>
struct Components {
  T* x;
  std::ptrdiff_t y, z;
  template <class Field>
  explicit Components(Field& f) : x(f.x.data()), y(f.y.data() - x), z(f.z.data() - x) {}
};

template <int W, class T>
HAIRMESH_INLINE V3<Lanes<T, W>> loadFrom(const T* at, std::ptrdiff_t y, std::ptrdiff_t z) {
  return {load<T, W>(at), load<T, W>(at + y), load<T, W>(at + z)};
}
template <int W, class T>
HAIRMESH_INLINE void addThere(T* at, std::ptrdiff_t y, std::ptrdiff_t z, const V3<Lanes<T, W>>& v) {
  addTo<T, W>(at, v.x);
  addTo<T, W>(at + y, v.y);
  addTo<T, W>(at + z, v.z);
}

// kStride: the pattern's, where it is known when this is compiled; else 0.
template <int kStride, class T>
HAIRMESH_INLINE void product(const ColumnPattern& pattern, const T* values, const Components<const T>& from,
                             const Components<T>& to) {
  constexpr int W = std::is_same_v<T, float> && kStride > 0 && kStride % kWideLanes == 0 ? kWideLanes : kLanes;
  const std::ptrdiff_t s = kStride > 0 ? kStride : pattern.stride;
  const std::ptrdiff_t xy = from.y, xz = from.z, yy = to.y, yz = to.z;
  const BlockDiagonal *d = pattern.diagonals.data(), *const end = d + pattern.diagonals.size();
  for (; d < end && d->symmetric(); ++d) {
    const T *m = values + d->values, *const stop = m + d->lanes, *x = from.x + d->row;
    for (T* y = to.x + d->row; m < stop; m += W, x += W, y += W) {
      const V3<Lanes<T, W>> v = loadFrom<W>(x, xy, xz);
      const Lanes<T, W> a = load<T, W>(m), b = load<T, W>(m + s), c = load<T, W>(m + 2 * s), e = load<T, W>(m + 3 * s),
                        f = load<T, W>(m + 4 * s), g = load<T, W>(m + 5 * s);
      addThere<W, T>(y, yy, yz,
                     {a * v.x + b * v.y + c * v.z, b * v.x + e * v.y + f * v.z, c * v.x + f * v.y + g * v.z});
    }
  }
  for (; d < end; ++d) {
    const T *at = values + d->values, *const stop = at + d->lanes;
    const T *xa = from.x + d->row, *xb = from.x + d->column;
    T *ya = to.x + d->row, *yb = to.x + d->column;
    for (; at < stop; at += W, xa += W, xb += W, ya += W, yb += W) {
      const V3<Lanes<T, W>> a = loadFrom<W>(xa, xy, xz), b = loadFrom<W>(xb, xy, xz);
      Lanes<T, W> m[9];
      for (int k = 0; k < 9; ++k) m[k] = load<T, W>(at + k * s);
      addThere<W, T>(ya, yy, yz,
                     {m[0] * b.x + m[1] * b.y + m[2] * b.z, m[3] * b.x + m[4] * b.y + m[5] * b.z,
                      m[6] * b.x + m[7] * b.y + m[8] * b.z});
      addThere<W, T>(yb, yy, yz,
                     {m[0] * a.x + m[3] * a.y + m[6] * a.z, m[1] * a.x + m[4] * a.y + m[7] * a.z,
                      m[2] * a.x + m[5] * a.y + m[8] * a.z});
    }
  }
}

// With the strides of the built-in styles known, addresses cost nothing.
template <class T>
HAIRMESH_INLINE void productOfStride(const ColumnPattern& p, const T* v, const Components<const T>& x,
                                     const Components<T>& y) {
  switch (p.stride) {
    case 8:
      return product<8>(p, v, x, y);
    case 16:
      return product<16>(p, v, x, y);
    case 24:
      return product<24>(p, v, x, y);
    case 32:
      return product<32>(p, v, x, y);
    case 40:
      return product<40>(p, v, x, y);
    default:
      return product<0>(p, v, x, y);
  }
}

HAIRMESH_CLONES void runProduct(const ColumnPattern& p, const float* v, const Components<const float>& x,
                                const Components<float>& y) {
  productOfStride(p, v, x, y);
}
HAIRMESH_CLONES void runProduct(const ColumnPattern& p, const double* v, const Components<const double>& x,
                                const Components<double>& y) {
  productOfStride(p, v, x, y);
}

}  // namespace

template <class T>
void multiply(const ColumnMatrix<T>& a, ColumnProduct<T>& scratch, std::span<const V3<T>> x, std::span<V3<T>> y) {
  scratch.x.pack(*a.layout, x);
  scratch.y.setZero();
  runProduct(*a.pattern, a.values.data(), Components<const T>(scratch.x), Components<T>(scratch.y));
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
