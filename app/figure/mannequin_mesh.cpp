// Surface nets (Gibson 1998): one vertex in every cell that the surface crosses, one quadrilateral around every grid
// edge that it crosses. Cells with more than one sheet would make edges of four triangles, so their corners are filled
// in first.
#include "app/figure/mannequin_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace app {

namespace {

constexpr int kBlock = 4;  // nodes a side of the blocks that are skipped when far from the surface
constexpr double kMaxGridNodes = 12e6;

struct Lattice {
  int nx = 0, ny = 0, nz = 0;
  std::vector<double> y, size;  // per row
  double cz = 0;
  std::vector<float> value;

  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(j) * nz + k) * nx + i; }
  bool border(int i, int j, int k) const {
    return i == 0 || j == 0 || k == 0 || i == nx - 1 || j == ny - 1 || k == nz - 1;
  }
  Vec3 point(double i, int j, double k) const {
    return {(i - 0.5 * (nx - 1)) * size[j], y[j], cz + (k - 0.5 * (nz - 1)) * size[j]};
  }
};

double cellSize(const MeshGrid& g, double y, double scale) {
  const double t = std::clamp((y - g.coarse_from) / std::max(g.fine_from - g.coarse_from, 1e-6), 0.0, 1.0);
  return scale * (g.coarse + (g.fine - g.coarse) * t * t * (3 - 2 * t));
}

Lattice layOut(const MeshGrid& g) {
  double low = 1e30, high = -1e30;
  for (const MeshGrid::Ball& ball : g.holds) {
    low = std::min(low, ball.center.y() - ball.radius);
    high = std::max(high, ball.center.y() + ball.radius);
  }
  for (double scale = 1;; scale *= 1.3) {
    Lattice l;
    for (double y = high; y > low - 2 * g.coarse * scale; y -= l.size.back()) {
      l.y.push_back(y);
      l.size.push_back(cellSize(g, y, scale));
    }
    std::reverse(l.y.begin(), l.y.end());
    std::reverse(l.size.begin(), l.size.end());
    l.ny = static_cast<int>(l.y.size());
    l.cz = g.center_z;
    // Rows narrow as their cells shrink: each ball has to fit into its finest row.
    double cells_x = 1, cells_z = 1;
    for (const MeshGrid::Ball& ball : g.holds) {
      const double size = cellSize(g, ball.center.y() + ball.radius, scale);
      cells_x = std::max(cells_x, (std::abs(ball.center.x()) + ball.radius) / size);
      cells_z = std::max(cells_z, (std::abs(ball.center.z() - l.cz) + ball.radius) / size);
    }
    const double nodes = (2 * cells_x + 4) * (2 * cells_z + 4) * l.ny;
    if (nodes > kMaxGridNodes) continue;
    l.nx = 2 * static_cast<int>(std::ceil(cells_x)) + 2;
    l.nz = 2 * static_cast<int>(std::ceil(cells_z)) + 2;
    l.value.assign(static_cast<std::size_t>(l.nx) * l.ny * l.nz, 1.0f);
    return l;
  }
}

// Samples the field near the surface; far blocks get the sign of their middle.
void sample(const std::function<double(const Vec3&)>& field, Lattice& l) {
  for (int j0 = 0; j0 < l.ny; j0 += kBlock) {
    const int j1 = std::min(j0 + kBlock, l.ny);
    for (int k0 = 0; k0 < l.nz; k0 += kBlock) {
      const int k1 = std::min(k0 + kBlock, l.nz);
      for (int i0 = 0; i0 < l.nx; i0 += kBlock) {
        const int i1 = std::min(i0 + kBlock, l.nx);
        const Vec3 middle = 0.5 * (l.point(0.5 * (i0 + i1 - 1), j0, 0.5 * (k0 + k1 - 1)) +
                                   l.point(0.5 * (i0 + i1 - 1), j1 - 1, 0.5 * (k0 + k1 - 1)));
        const double radius =
            std::max((l.point(i0, j0, k0) - middle).norm(), (l.point(i1 - 1, j1 - 1, k1 - 1) - middle).norm());
        const double at_middle = field(middle);
        const bool far = std::abs(at_middle) > 1.6 * radius + 0.004;
        for (int j = j0; j < j1; ++j)
          for (int k = k0; k < k1; ++k)
            for (int i = i0; i < i1; ++i)
              l.value[l.index(i, j, k)] = static_cast<float>(far ? at_middle : field(l.point(i, j, k)));
      }
    }
  }
  for (int j = 0; j < l.ny; ++j)
    for (int k = 0; k < l.nz; ++k)
      for (int i = 0; i < l.nx; ++i)
        if (l.border(i, j, k)) l.value[l.index(i, j, k)] = std::max(l.value[l.index(i, j, k)], 1e-4f);
}

// Corner c of a cell: bit 0 = x, bit 1 = y, bit 2 = z.
bool connected(unsigned corners) {
  if (corners == 0) return true;
  unsigned reached = corners & (0u - corners);
  for (int round = 0; round < 7; ++round) {
    const unsigned x = ((reached & 0x55u) << 1) | ((reached & 0xAAu) >> 1);
    const unsigned y = ((reached & 0x33u) << 2) | ((reached & 0xCCu) >> 2);
    const unsigned z = ((reached & 0x0Fu) << 4) | ((reached & 0xF0u) >> 4);
    reached |= (x | y | z) & corners;
  }
  return reached == corners;
}

std::array<bool, 256> simpleCells() {
  std::array<bool, 256> simple{};
  for (unsigned mask = 0; mask < 256; ++mask) simple[mask] = connected(mask) && connected(~mask & 255u);
  return simple;
}

struct Cells {
  const Lattice& l;
  std::array<std::size_t, 8> corner_offset;

  explicit Cells(const Lattice& lattice) : l(lattice) {
    for (int c = 0; c < 8; ++c) corner_offset[c] = l.index(c & 1, (c >> 1) & 1, c >> 2);
  }
  unsigned mask(std::size_t first) const {
    unsigned m = 0;
    for (int c = 0; c < 8; ++c) m |= (l.value[first + corner_offset[c]] < 0 ? 1u : 0u) << c;
    return m;
  }
};

// Fills corners of cells with two sheets until none is left: each filling only adds inside nodes, so it ends.
void fillDoubleSheets(Lattice& l) {
  static const std::array<bool, 256> simple = simpleCells();
  const Cells cells(l);
  for (bool changed = true; changed;) {
    changed = false;
    for (int j = 0; j + 1 < l.ny; ++j) {
      for (int k = 0; k + 1 < l.nz; ++k) {
        for (int i = 0; i + 1 < l.nx; ++i) {
          const std::size_t first = l.index(i, j, k);
          const unsigned mask = cells.mask(first);
          if (simple[mask]) continue;
          std::size_t best = 0;
          float least = 1e30f;
          for (int c = 0; c < 8; ++c) {
            const std::size_t n = first + cells.corner_offset[c];
            if (l.border(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2))) continue;
            if (l.value[n] >= 0 && l.value[n] < least) {
              least = l.value[n];
              best = n;
            }
          }
          if (least == 1e30f) continue;
          l.value[best] = -1e-5f;
          changed = true;
        }
      }
    }
  }
}

// The mean of the points where the surface crosses the cell's edges.
Vec3 cellVertex(const Lattice& l, const Cells& cells, int i, int j, int k, std::size_t first) {
  Vec3 sum = Vec3::Zero();
  int crossings = 0;
  for (int c = 0; c < 8; ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      if (c & (1 << axis)) continue;
      const int d = c | (1 << axis);
      const double a = l.value[first + cells.corner_offset[c]], b = l.value[first + cells.corner_offset[d]];
      if ((a < 0) == (b < 0)) continue;
      const double t = a / (a - b);
      const Vec3 p = l.point(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2));
      const Vec3 q = l.point(i + (d & 1), j + ((d >> 1) & 1), k + (d >> 2));
      sum += p + std::clamp(t, 0.05, 0.95) * (q - p);
      ++crossings;
    }
  }
  return sum / crossings;
}

void addQuad(const std::array<std::int32_t, 4>& v, bool flip, Surface& surface) {
  std::array<std::uint32_t, 4> q;
  for (int c = 0; c < 4; ++c) q[c] = static_cast<std::uint32_t>(v[flip ? 3 - c : c]);
  const auto& p = surface.positions;
  const bool first_diagonal = (p[q[0]] - p[q[2]]).squaredNorm() <= (p[q[1]] - p[q[3]]).squaredNorm();
  if (first_diagonal)
    surface.triangles.insert(surface.triangles.end(), {q[0], q[1], q[2], q[0], q[2], q[3]});
  else
    surface.triangles.insert(surface.triangles.end(), {q[1], q[2], q[3], q[1], q[3], q[0]});
}

// Value and gradient from the corners of a small tetrahedron: four samples instead of seven.
double probe(const std::function<double(const Vec3&)>& field, const Vec3& p, Vec3& gradient) {
  constexpr double h = 4e-4;
  static const std::array<Vec3, 4> corners{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
  double sum = 0;
  gradient.setZero();
  for (const Vec3& c : corners) {
    const double f = field(p + h * c);
    sum += f;
    gradient += f * c;
  }
  gradient /= 4 * h;
  return sum / 4;
}

}  // namespace

void projectToSurface(const std::function<double(const Vec3&)>& field, double limit, Vec3& p, Vec3& normal) {
  Vec3 gradient;
  double f = probe(field, p, gradient);
  for (int step = 0; step < 2; ++step) {
    const double g2 = std::max(gradient.squaredNorm(), 1e-4);
    Vec3 move = -f / g2 * gradient;
    if (const double n = move.norm(); n > limit) move *= limit / n;
    p += move;
    f = step == 0 ? field(p) : 0;
  }
  probe(field, p, gradient);
  const double n = gradient.norm();
  normal = n > 1e-9 ? Vec3(gradient / n) : Vec3(Vec3::UnitY());
}

Surface meshSurface(const std::function<double(const Vec3&)>& field, const MeshGrid& grid) {
  Lattice l = layOut(grid);
  sample(field, l);
  fillDoubleSheets(l);

  Surface surface;
  const Cells cells(l);
  std::vector<std::int32_t> vertex(l.value.size(), -1);
  std::vector<double> limits;
  for (int j = 0; j + 1 < l.ny; ++j) {
    for (int k = 0; k + 1 < l.nz; ++k) {
      for (int i = 0; i + 1 < l.nx; ++i) {
        const std::size_t first = l.index(i, j, k);
        const unsigned mask = cells.mask(first);
        if (mask == 0 || mask == 255) continue;
        vertex[first] = static_cast<std::int32_t>(surface.positions.size());
        surface.positions.push_back(cellVertex(l, cells, i, j, k, first));
        limits.push_back(0.7 * l.size[j]);
      }
    }
  }
  surface.normals.resize(surface.positions.size());
  for (std::size_t v = 0; v < surface.positions.size(); ++v)
    projectToSurface(field, limits[v], surface.positions[v], surface.normals[v]);

  const std::array<std::size_t, 3> step{l.index(1, 0, 0), l.index(0, 1, 0), l.index(0, 0, 1)};
  for (int j = 1; j + 1 < l.ny; ++j) {
    for (int k = 1; k + 1 < l.nz; ++k) {
      for (int i = 1; i + 1 < l.nx; ++i) {
        const std::size_t n = l.index(i, j, k);
        const bool inside = l.value[n] < 0;
        for (int axis = 0; axis < 3; ++axis) {
          if (inside == (l.value[n + step[axis]] < 0)) continue;
          const std::size_t b = step[(axis + 1) % 3], c = step[(axis + 2) % 3];
          addQuad({vertex[n - b - c], vertex[n - c], vertex[n], vertex[n - b]}, !inside, surface);
        }
      }
    }
  }
  return surface;
}

}  // namespace app
