// q: quaternion, A: sum of (x_j - x_i)(X_j - X_i)^T, a0, a1, a2: its columns, r0, r1, r2: those of the rotation.
#include "sim/linear/rotation.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sim {
namespace {

constexpr int kIterations = 3;  // from the last step's rotation; a preconditioner needs no more than a few degrees

template <class T>
struct Quaternion {
  T x, y, z, w;
};

// Columns of the rotation matrix.
template <class T>
HAIRMESH_INLINE void toColumns(const Quaternion<T>& q, V3<T>* r) {
  const T one = constant<T>(1), two = constant<T>(2);
  r[0] = {one - two * (q.y * q.y + q.z * q.z), two * (q.x * q.y + q.w * q.z), two * (q.x * q.z - q.w * q.y)};
  r[1] = {two * (q.x * q.y - q.w * q.z), one - two * (q.x * q.x + q.z * q.z), two * (q.y * q.z + q.w * q.x)};
  r[2] = {two * (q.x * q.z + q.w * q.y), two * (q.y * q.z - q.w * q.x), one - two * (q.x * q.x + q.y * q.y)};
}

// q <- (rotation by the vector w) q, normalized. tan(angle / 2) is taken as half the vector: small steps need no more.
template <class T>
HAIRMESH_INLINE void turn(const V3<T>& w, Quaternion<T>& q) {
  const T half = constant<T>(0.5), a = half * w.x, b = half * w.y, c = half * w.z;
  const Quaternion<T> p{q.x + a * q.w + b * q.z - c * q.y, q.y + b * q.w + c * q.x - a * q.z,
                        q.z + c * q.w + a * q.y - b * q.x, q.w - a * q.x - b * q.y - c * q.z};
  const T inverse = constant<T>(1) / squareRoot(p.x * p.x + p.y * p.y + p.z * p.z + p.w * p.w);
  q = {inverse * p.x, inverse * p.y, inverse * p.z, inverse * p.w};
}

template <class T>
HAIRMESH_INLINE void addEdges(VertexRotations<T>& r) {
  for (const auto& strip : r.strips) {
    for (int l = 0; l < strip.lanes; l += kLanes) {
      const V3<Lanes<T>> d = loadAt(r.x_packed, strip.b + l) - loadAt(r.x_packed, strip.a + l);
      for (int axis = 0; axis < 3; ++axis) {
        const Lanes<T> e = load<T>(r.rest[axis].data() + strip.rest + l);
        const std::array<Lanes<T>, 3> product{e * d.x, e * d.y, e * d.z};
        for (int k = 0; k < 3; ++k) {
          addTo<T>(r.sums[3 * axis + k].data() + strip.a + l, product[k]);
          addTo<T>(r.sums[3 * axis + k].data() + strip.b + l, product[k]);
        }
      }
    }
  }
}

template <class T>
HAIRMESH_INLINE void turnAll(VertexRotations<T>& r) {
  const Lanes<T> zero = constant<Lanes<T>>(0), one = constant<Lanes<T>>(1);
  for (int at = ColumnLayout::kMargin; at < r.layout.size() - ColumnLayout::kMargin; at += kLanes) {
    const Lanes<T> scale = load<T>(r.inverse_square.data() + at);
    V3<Lanes<T>> a[3];
    for (int axis = 0; axis < 3; ++axis) {
      a[axis] = scale * V3<Lanes<T>>{load<T>(r.sums[3 * axis].data() + at), load<T>(r.sums[3 * axis + 1].data() + at),
                                     load<T>(r.sums[3 * axis + 2].data() + at)};
    }
    Quaternion<Lanes<T>> q{load<T>(r.quaternions[0].data() + at), load<T>(r.quaternions[1].data() + at),
                           load<T>(r.quaternions[2].data() + at), load<T>(r.quaternions[3].data() + at)};
    V3<Lanes<T>> c[3];
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      toColumns(q, c);
      const V3<Lanes<T>> torque = cross(c[0], a[0]) + cross(c[1], a[1]) + cross(c[2], a[2]);
      const Lanes<T> fit = dot(c[0], a[0]) + dot(c[1], a[1]) + dot(c[2], a[2]);
      const Lanes<T> size = (fit < zero ? -fit : fit) + constant<Lanes<T>>(1e-6);
      turn((one / size) * torque, q);
    }
    // Where it is not a number it starts over.
    const auto fine = q.w * q.w <= constant<Lanes<T>>(1.02);
    q = {fine ? q.x : zero, fine ? q.y : zero, fine ? q.z : zero, fine ? q.w : one};
    store<T>(r.quaternions[0].data() + at, q.x), store<T>(r.quaternions[1].data() + at, q.y);
    store<T>(r.quaternions[2].data() + at, q.z), store<T>(r.quaternions[3].data() + at, q.w);
    toColumns(q, c);
    for (int axis = 0; axis < 3; ++axis) {
      store<T>(r.sums[3 * axis].data() + at, c[axis].x), store<T>(r.sums[3 * axis + 1].data() + at, c[axis].y);
      store<T>(r.sums[3 * axis + 2].data() + at, c[axis].z);
    }
  }
}

HAIRMESH_CLONES void run(VertexRotations<float>& r) {
  addEdges(r);
  turnAll(r);
}
HAIRMESH_CLONES void run(VertexRotations<double>& r) {
  addEdges(r);
  turnAll(r);
}

}  // namespace

template <class T>
VertexRotations<T>::VertexRotations(const HairMesh& mesh) : layout(mesh), x_packed(layout) {
  const auto& shape = mesh.shape;
  // Root edges with as many layers as the deepest bundle beside them; each column's own edges.
  std::map<std::pair<int, int>, int> layers;
  for (std::size_t f = 0; f < shape.root_faces.size(); ++f) {
    const RootFace& face = shape.root_faces[f];
    for (int k = 0; k < face.corner_count; ++k) {
      int& most = layers[std::minmax(face.columns[k], face.columns[(k + 1) % face.corner_count])];
      most = std::max(most, mesh.bundle_layers[f]);
    }
  }
  std::vector<double> longest(layout.size(), 0);
  const auto addStrip = [&](int column_a, int column_b, int step, int count) {
    const int first = static_cast<int>(rest[0].size()), lanes = (count + kLanes - 1) / kLanes * kLanes;
    strips.push_back({layout.first(column_a), layout.first(column_b) + step, first, lanes});
    for (auto& values : rest) values.resize(first + lanes, T(0));
    for (int l = 0; l < count; ++l) {
      const Vec3 e =
          shape.positions[shape.column_first[column_b] + l + step] - shape.positions[shape.column_first[column_a] + l];
      for (int axis = 0; axis < 3; ++axis) rest[axis][first + l] = static_cast<T>(e[axis]);
      for (double* at : {&longest[layout.first(column_a) + l], &longest[layout.first(column_b) + l + step]}) {
        *at = std::max(*at, e.squaredNorm());
      }
    }
  };
  for (int c = 0; c < layout.columns; ++c) addStrip(c, c, 1, layout.length[c] - 1);
  for (const auto& [columns, count] : layers) addStrip(columns.first, columns.second, 0, count);
  for (auto& array : sums) array.resize(layout.size());
  for (auto& array : quaternions) array.resize(layout.size());
  std::fill(quaternions[3].begin(), quaternions[3].end(), T(1));
  for (const double square : longest) inverse_square.push_back(static_cast<T>(square > 0 ? 1 / square : 0));
  matrices.assign(mesh.vertexCount(), {1, 0, 0, 0, 1, 0, 0, 0, 1});
}

template <class T>
void VertexRotations<T>::update(std::span<const V3<T>> x) {
  x_packed.pack(layout, x);
  for (auto& array : sums) std::fill(array.begin(), array.end(), T(0));
  run(*this);
  for (std::size_t v = 0; v < matrices.size(); ++v) {
    const int at = layout.slot[v];
    for (int k = 0; k < 9; ++k) matrices[v].m[k] = sums[3 * (k % 3) + k / 3][at];
  }
}

template struct VertexRotations<float>;
template struct VertexRotations<double>;

}  // namespace sim
