#include "app/figure/signed_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace app {

double SignedGrid::interpolate(const Vec3& p) const {
  const Vec3 high = low + h * Vec3(n[0] - 1, n[1] - 1, n[2] - 1);
  const Vec3 inside = p.cwiseMax(low).cwiseMin(high);
  const Vec3 u = (inside - low) / h;
  std::array<int, 3> c;
  std::array<double, 3> f;
  for (int a = 0; a < 3; ++a) {
    c[a] = std::clamp(static_cast<int>(u[a]), 0, n[a] - 2);
    f[a] = u[a] - c[a];
  }
  const std::size_t base = index(c[0], c[1], c[2]), dy = static_cast<std::size_t>(n[0]), dz = dy * n[1];
  const auto along = [&](std::size_t at) { return distance[at] + f[0] * (distance[at + 1] - distance[at]); };
  const double near = along(base) + f[1] * (along(base + dy) - along(base));
  const double far = along(base + dz) + f[1] * (along(base + dz + dy) - along(base + dz));
  return near + f[2] * (far - near) + (p - inside).norm();
}

namespace {

constexpr std::uint8_t kInside = 2;  // votes of three
constexpr float kUnreached = 1e3f;   // m, of nodes that no distance has reached

// From the closest point of a triangle to a point (by barycentric regions; Ericson, Real-Time Collision
// Detection, 5.1.5).
Vec3 offTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return ap - d1 / (d1 - d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return ap - d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  if (!(sum > 0)) return ap;
  return ap - vb / sum * ab - vc / sum * ac;
}

using Triangles = std::vector<Triangle>;

// Adds one vote for every node that a line along `axis` finds inside: crossings counted with their sense.
void voteInside(const Triangles& triangles, int axis, const SignedGrid& g, std::vector<std::uint8_t>& votes) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  struct Crossing {
    float at;
    int sense;
  };
  std::vector<std::vector<Crossing>> lines(static_cast<std::size_t>(g.n[u]) * g.n[v]);
  // Lines pass a hair's breadth beside the nodes, so that none runs exactly through a vertex of a symmetric mesh.
  const double shift_u = 1.37e-5, shift_v = 2.71e-5;
  for (const auto& t : triangles) {
    const double area = (t[1][u] - t[0][u]) * (t[2][v] - t[0][v]) - (t[1][v] - t[0][v]) * (t[2][u] - t[0][u]);
    if (area == 0) continue;
    const double low_u = std::min({t[0][u], t[1][u], t[2][u]}), high_u = std::max({t[0][u], t[1][u], t[2][u]});
    const double low_v = std::min({t[0][v], t[1][v], t[2][v]}), high_v = std::max({t[0][v], t[1][v], t[2][v]});
    const int first_u = std::max(0, static_cast<int>(std::ceil((low_u - shift_u - g.low[u]) / g.h)));
    const int last_u = std::min(g.n[u] - 1, static_cast<int>(std::floor((high_u - shift_u - g.low[u]) / g.h)));
    const int first_v = std::max(0, static_cast<int>(std::ceil((low_v - shift_v - g.low[v]) / g.h)));
    const int last_v = std::min(g.n[v] - 1, static_cast<int>(std::floor((high_v - shift_v - g.low[v]) / g.h)));
    for (int b = first_v; b <= last_v; ++b) {
      for (int a = first_u; a <= last_u; ++a) {
        const double pu = g.low[u] + a * g.h + shift_u, pv = g.low[v] + b * g.h + shift_v;
        double w[3];
        for (int c = 0; c < 3; ++c) {
          const Vec3 &p = t[(c + 1) % 3], &q = t[(c + 2) % 3];
          w[c] = ((p[u] - pu) * (q[v] - pv) - (p[v] - pv) * (q[u] - pu)) / area;
        }
        if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
        const double at = w[0] * t[0][axis] + w[1] * t[1][axis] + w[2] * t[2][axis];
        lines[static_cast<std::size_t>(b) * g.n[u] + a].push_back({static_cast<float>(at), area > 0 ? -1 : 1});
      }
    }
  }
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(g.n[0]),
                                          static_cast<std::size_t>(g.n[0]) * g.n[1]};
  for (int b = 0; b < g.n[v]; ++b) {
    for (int a = 0; a < g.n[u]; ++a) {
      auto& crossings = lines[static_cast<std::size_t>(b) * g.n[u] + a];
      if (crossings.empty()) continue;
      std::sort(crossings.begin(), crossings.end(), [](const Crossing& x, const Crossing& y) { return x.at < y.at; });
      std::size_t next = 0;
      int depth = 0;
      for (int i = 0; i < g.n[axis]; ++i) {
        const double at = g.low[axis] + i * g.h;
        for (; next < crossings.size() && crossings[next].at < at; ++next) depth += crossings[next].sense;
        if (depth > 0) ++votes[i * stride[axis] + a * stride[u] + b * stride[v]];
      }
    }
  }
}

// Whether the cell that holds p lies inside altogether.
bool buried(const Vec3& p, const std::vector<std::uint8_t>& votes, const SignedGrid& g) {
  std::array<int, 3> c;
  for (int a = 0; a < 3; ++a) {
    c[a] = static_cast<int>(std::floor((p[a] - g.low[a]) / g.h));
    if (c[a] < 0 || c[a] + 1 >= g.n[a]) return false;
  }
  for (int k = 0; k < 8; ++k)
    if (votes[g.index(c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2))] < kInside) return false;
  return true;
}

// Exact distances at the nodes within `reach` of each triangle; elsewhere left at their large start value. With votes
// triangles within the solid count for no node inside.
void rasterizeBand(const Triangles& triangles, double reach, const std::vector<std::uint8_t>* votes, SignedGrid& g) {
  for (const auto& t : triangles) {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();  // nought of a triangle without area
    const Vec3 low = t[0].cwiseMin(t[1]).cwiseMin(t[2]), high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    const Vec3 middle = 0.5 * (low + high);
    const double radius = 1.0001 * 0.5 * (high - low).norm();  // of a ball that holds it
    std::array<int, 3> first, last;
    for (int a = 0; a < 3; ++a) {
      first[a] = std::max(0, static_cast<int>(std::ceil((low[a] - reach - g.low[a]) / g.h)));
      last[a] = std::min(g.n[a] - 1, static_cast<int>(std::floor((high[a] + reach - g.low[a]) / g.h)));
    }
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i) {
          const std::size_t at = g.index(i, j, k);
          float& d = g.distance[at];
          const Vec3 p = g.point(i, j, k);
          const double most = 1.0001 * d;  // what is farther changes nothing
          if ((p - middle).squaredNorm() > (most + radius) * (most + radius)) continue;
          if (std::abs(normal.dot(p - t[0])) > most) continue;
          const Vec3 off = offTriangle(p, t[0], t[1], t[2]);
          if (votes && (*votes)[at] >= kInside && buried(p - off + g.h * normal, *votes, g)) continue;
          d = std::min(d, static_cast<float>(std::sqrt(off.squaredNorm())));
        }
  }
}

// Distance at a node that lies h from one neighbour on each axis; m: theirs.
float eikonal(std::array<float, 3> m, float h) {
  if (m[0] > m[1]) std::swap(m[0], m[1]);
  if (m[1] > m[2]) std::swap(m[1], m[2]);
  if (m[0] > m[1]) std::swap(m[0], m[1]);
  float x = m[0] + h;
  if (x > m[1]) x = 0.5f * (m[0] + m[1] + std::sqrt(std::max(0.0f, 2 * h * h - (m[0] - m[1]) * (m[0] - m[1]))));
  if (x <= m[2]) return x;
  const float sum = m[0] + m[1] + m[2], squares = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
  return (sum + std::sqrt(std::max(0.0f, sum * sum - 3 * (squares - h * h)))) / 3;
}

// Spreads distances over the grid: Gauss-Seidel sweeps of the eikonal equation (Zhao 2005), nodes of the band held. A
// node none of whose neighbours has changed since it was last visited is left out (Bak, McLaughlin and Renzi 2010).
void sweepFar(double band, SignedGrid& g) {
  const float h = static_cast<float>(g.h), held = static_cast<float>(band);
  const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(g.n[0]),
                                          static_cast<std::size_t>(g.n[0]) * g.n[1]};
  std::vector<std::uint8_t> due(g.distance.size(), 0);
  // What has none but untouched neighbours cannot change before one of them does.
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i) {
        const std::size_t at = g.index(i, j, k);
        if (g.distance[at] >= kUnreached) continue;
        const std::array<int, 3> c{i, j, k};
        for (int a = 0; a < 3; ++a) {
          if (c[a] > 0) due[at - stride[a]] = 1;
          if (c[a] + 1 < g.n[a]) due[at + stride[a]] = 1;
        }
      }
  for (int sweep = 0; sweep < 8; ++sweep) {
    const auto order = [&](int axis, int i) { return (sweep >> axis) & 1 ? g.n[axis] - 1 - i : i; };
    for (int kk = 0; kk < g.n[2]; ++kk) {
      for (int jj = 0; jj < g.n[1]; ++jj) {
        const std::size_t row = g.index(0, order(1, jj), order(2, kk));
        for (int ii = 0; ii < g.n[0]; ++ii) {
          const std::size_t at = row + static_cast<std::size_t>(order(0, ii));
          if (!due[at] || g.distance[at] < held) continue;
          due[at] = 0;
          const std::array<int, 3> c{order(0, ii), order(1, jj), order(2, kk)};
          std::array<float, 3> m;
          for (int a = 0; a < 3; ++a) {
            const float before = c[a] > 0 ? g.distance[at - stride[a]] : kUnreached;
            const float after = c[a] + 1 < g.n[a] ? g.distance[at + stride[a]] : kUnreached;
            m[a] = std::min(before, after);
          }
          const float x = eikonal(m, h);
          if (x >= g.distance[at]) continue;
          g.distance[at] = x;
          for (int a = 0; a < 3; ++a) {
            if (c[a] > 0 && g.distance[at - stride[a]] > x) due[at - stride[a]] = 1;
            if (c[a] + 1 < g.n[a] && g.distance[at + stride[a]] > x) due[at + stride[a]] = 1;
          }
        }
      }
    }
  }
}

}  // namespace

SignedGrid layOutGrid(const Vec3& low, const Vec3& high, double h) {
  SignedGrid g;
  g.h = h;
  g.low = low;
  for (int a = 0; a < 3; ++a) g.n[a] = std::max(2, static_cast<int>(std::ceil((high[a] - low[a]) / h)) + 1);
  g.distance.assign(static_cast<std::size_t>(g.n[0]) * g.n[1] * g.n[2], kUnreached);
  return g;
}

void fillGrid(const std::vector<Triangle>& triangles, double band, Pieces pieces, SignedGrid& grid) {
  std::vector<std::uint8_t> votes(grid.distance.size(), 0);
  for (int axis = 0; axis < 3; ++axis) voteInside(triangles, axis, grid, votes);
  rasterizeBand(triangles, band, pieces == Pieces::kOneSolid ? &votes : nullptr, grid);
  sweepFar(band, grid);
  for (std::size_t i = 0; i < votes.size(); ++i)
    if (votes[i] >= kInside) grid.distance[i] = -grid.distance[i];
}

}  // namespace app
