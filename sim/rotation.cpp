#include "sim/rotation.h"

#include <algorithm>
#include <cmath>

#include "sim/deformation.h"

namespace sim {
namespace {

constexpr int kIterations = 3;  // from the last step's rotation; a preconditioner needs no more than a few degrees

template <class T>
M3<T> toMatrix(const std::array<T, 4>& q) {
  const T x = q[0], y = q[1], z = q[2], w = q[3];
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

// q <- (rotation by the vector w) q, normalized. tan(angle / 2) is taken as half the vector: small steps need no more.
template <class T>
void turn(const V3<T>& w, std::array<T, 4>& q) {
  const T a = T(0.5) * w.x, b = T(0.5) * w.y, c = T(0.5) * w.z;
  std::array<T, 4> p{q[0] + a * q[3] + b * q[2] - c * q[1], q[1] + b * q[3] + c * q[0] - a * q[2],
                     q[2] + c * q[3] + a * q[1] - b * q[0], q[3] - a * q[0] - b * q[1] - c * q[2]};
  const T inverse = T(1) / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
  for (int k = 0; k < 4; ++k) q[k] = p[k] * inverse;
}

}  // namespace

template <class T>
VertexRotations<T>::VertexRotations(const HairMesh& mesh) {
  const EdgeLaplacian graph = makeEdgeLaplacian(mesh);
  row_first = graph.row_first;
  neighbours = graph.neighbours;
  for (int i = 0; i < graph.size(); ++i) {
    double longest = 0;
    for (int k = row_first[i]; k < row_first[i + 1]; ++k) {
      longest = std::max(longest, (mesh.shape.positions[neighbours[k]] - mesh.shape.positions[i]).squaredNorm());
    }
    for (int k = row_first[i]; k < row_first[i + 1]; ++k) {
      const Vec3 e = (mesh.shape.positions[neighbours[k]] - mesh.shape.positions[i]) / longest;
      rest_edge.push_back({static_cast<T>(e.x()), static_cast<T>(e.y()), static_cast<T>(e.z())});
    }
  }
  quaternions.assign(graph.size(), {0, 0, 0, 1});
  matrices.assign(graph.size(), toMatrix<T>({0, 0, 0, 1}));
}

template <class T>
void VertexRotations<T>::update(std::span<const V3<T>> x) {
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    // Columns of sum (x_j - x_i)(X_j - X_i)^T.
    V3<T> a0{0, 0, 0}, a1{0, 0, 0}, a2{0, 0, 0};
    for (int k = row_first[i]; k < row_first[i + 1]; ++k) {
      const V3<T> d = x[neighbours[k]] - x[i], e = rest_edge[k];
      a0 += e.x * d;
      a1 += e.y * d;
      a2 += e.z * d;
    }
    std::array<T, 4> q = quaternions[i];
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      const M3<T> r = toMatrix(q);
      const V3<T> r0{r.m[0], r.m[3], r.m[6]}, r1{r.m[1], r.m[4], r.m[7]}, r2{r.m[2], r.m[5], r.m[8]};
      const V3<T> torque = cross(r0, a0) + cross(r1, a1) + cross(r2, a2);
      const T fit = dot(r0, a0) + dot(r1, a1) + dot(r2, a2);
      turn((T(1) / (std::abs(fit) + T(1e-6))) * torque, q);
    }
    if (!(std::abs(q[3]) <= T(1.01))) q = {0, 0, 0, 1};  // not a number: start over
    quaternions[i] = q;
    matrices[i] = toMatrix(q);
  }
}

template struct VertexRotations<float>;
template struct VertexRotations<double>;

}  // namespace sim
