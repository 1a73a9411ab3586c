// u: displacement, r: residual -A^T A u at free vertices, z: r over the degree, d: search direction, q = A^T A d.
#include "sim/deformation.h"

#include <algorithm>
#include <set>

namespace sim {
namespace {

constexpr int kMostIterations = 1000;

void applyLaplacian(const EdgeLaplacian& laplacian, std::span<const unsigned char> held, std::span<const Vec3> u,
                    std::span<Vec3> out) {
  for (int i = 0; i < laplacian.size(); ++i) {
    if (held[i]) {
      out[i].setZero();
      continue;
    }
    Vec3 sum = laplacian.degree(i) * u[i];
    for (int k = laplacian.row_first[i]; k < laplacian.row_first[i + 1]; ++k) sum -= u[laplacian.neighbours[k]];
    out[i] = sum;
  }
}

double innerProduct(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace

EdgeLaplacian makeEdgeLaplacian(const HairMesh& mesh) {
  std::vector<std::set<int>> rows(mesh.vertexCount());
  const auto join = [&](int a, int b) { rows[a].insert(b), rows[b].insert(a); };
  for (const Prism& prism : mesh.prisms) {
    for (int k = 0; k < prism.corner_count; ++k) {
      const int next = (k + 1) % prism.corner_count;
      join(prism.v[k], prism.v[next]);
      join(prism.v[prism.corner_count + k], prism.v[prism.corner_count + next]);
      join(prism.v[k], prism.v[prism.corner_count + k]);
    }
  }
  EdgeLaplacian laplacian;
  for (const auto& row : rows) {
    laplacian.neighbours.insert(laplacian.neighbours.end(), row.begin(), row.end());
    laplacian.row_first.push_back(static_cast<int>(laplacian.neighbours.size()));
  }
  return laplacian;
}

int minimizeDeformation(const EdgeLaplacian& laplacian, std::span<const unsigned char> held, double tolerance,
                        MinimizationScratch& scratch, std::span<Vec3> displacement) {
  const int n = laplacian.size();
  bool moved = false;
  for (int i = 0; i < n; ++i) moved = moved || (held[i] && !displacement[i].isZero(0));
  if (!moved) {
    for (int i = 0; i < n; ++i) displacement[i].setZero();
    return 0;
  }
  auto& [r, z, d, q] = scratch;
  for (auto* v : {&r, &z, &d, &q}) v->resize(n);
  applyLaplacian(laplacian, held, displacement, q);
  for (int i = 0; i < n; ++i) {
    r[i] = -q[i];
    d[i] = z[i] = r[i] / std::max(1, laplacian.degree(i));
  }
  double delta = innerProduct(r, z);
  const double goal = tolerance * tolerance * delta;
  int iterations = 0;
  while (delta > goal && iterations < kMostIterations) {
    applyLaplacian(laplacian, held, d, q);
    const double curvature = innerProduct(d, q);
    if (!(curvature > 0)) break;
    const double alpha = delta / curvature;
    for (int i = 0; i < n; ++i) {
      displacement[i] += alpha * d[i];
      r[i] -= alpha * q[i];
      z[i] = r[i] / std::max(1, laplacian.degree(i));
    }
    const double next = innerProduct(r, z);
    for (int i = 0; i < n; ++i) d[i] = z[i] + (next / delta) * d[i];
    delta = next;
    ++iterations;
  }
  return iterations;
}

}  // namespace sim
