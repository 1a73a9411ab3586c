#include "app/figure/closed_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace app {

namespace {

using sim::Vec3;

constexpr double kWeld = 1e-5;     // of the size; vertices so near are one
constexpr double kSample = 0.008;  // m

// Per vertex: the first vertex of its connected piece.
std::vector<int> piecesOf(const ClosedSurface& surface) {
  std::vector<int> above(surface.points.size());
  std::iota(above.begin(), above.end(), 0);
  const auto top = [&](int v) {
    while (above[static_cast<std::size_t>(v)] != v) {
      int& up = above[static_cast<std::size_t>(v)];
      v = up = above[static_cast<std::size_t>(up)];
    }
    return v;
  };
  for (const auto& f : surface.faces) {
    for (const int v : {f[1], f[2]}) {
      const int one = top(f[0]), other = top(v);
      above[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
    }
  }
  for (std::size_t v = 0; v < above.size(); ++v) above[v] = top(static_cast<int>(v));
  return above;
}

}  // namespace

ClosedSurface weld(const PolygonMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  const double cell = std::max(1e-12, kWeld * box.sizes().maxCoeff());
  std::map<std::array<long, 3>, int> seen;
  ClosedSurface surface;
  std::vector<int> welded;
  for (const Vec3& p : mesh.positions) {
    const Eigen::Vector3d at = (p - box.min()) / cell;
    const auto [found, fresh] = seen.try_emplace({std::lround(at.x()), std::lround(at.y()), std::lround(at.z())},
                                                 static_cast<int>(surface.points.size()));
    if (fresh) surface.points.push_back(p);
    welded.push_back(found->second);
  }
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const auto corners = mesh.face(f);
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const std::array<int, 3> face{welded[static_cast<std::size_t>(corners[0])],
                                    welded[static_cast<std::size_t>(corners[k - 1])],
                                    welded[static_cast<std::size_t>(corners[k])]};
      if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) surface.faces.push_back(face);
    }
  }
  return surface;
}

int openEdges(const ClosedSurface& surface) {
  std::map<std::pair<int, int>, int> sides;
  for (const auto& f : surface.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = f[k], b = f[(k + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return static_cast<int>(std::ranges::count_if(sides, [](const auto& side) { return side.second != 0; }));
}

int turnOutwards(ClosedSurface& surface) {
  const std::vector<int> piece = piecesOf(surface);
  std::map<int, double> volume;
  const auto at = [&](int v) -> const Vec3& { return surface.points[static_cast<std::size_t>(v)]; };
  for (const auto& f : surface.faces)
    volume[piece[static_cast<std::size_t>(f[0])]] += at(f[0]).dot(at(f[1]).cross(at(f[2]))) / 6;
  for (auto& f : surface.faces) {
    if (volume[piece[static_cast<std::size_t>(f[0])]] < 0) std::swap(f[1], f[2]);
  }
  return static_cast<int>(volume.size());
}

double largestPiece(const ClosedSurface& surface) {
  const std::vector<int> piece = piecesOf(surface);
  std::map<int, int> faces;
  int most = 0;
  for (const auto& f : surface.faces) most = std::max(most, ++faces[piece[static_cast<std::size_t>(f[0])]]);
  return surface.faces.empty() ? 0 : static_cast<double>(most) / static_cast<double>(surface.faces.size());
}

std::vector<Vec3> samplesOf(const ClosedSurface& surface) {
  std::vector<Vec3> samples;
  for (const auto& f : surface.faces) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = surface.points[static_cast<std::size_t>(f[k])];
    const double longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
    if (longest < kSample) {
      samples.push_back(p[0]);
      continue;
    }
    const int parts = static_cast<int>(std::ceil(longest / kSample));
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) samples.push_back(p[0] + (i * (p[1] - p[0]) + j * (p[2] - p[0])) / parts);
    }
  }
  return samples;
}

}  // namespace app
