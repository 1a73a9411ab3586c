#include "app/groom/fit/root_raster.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace app {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kSmallestCell = 0.003f, kLargestCell = 0.012f;  // m; the largest: of a head, more of larger things
constexpr double kStrandsPerCell = 3;
constexpr double kHeadRadius = 0.09;   // m
constexpr float kLargestHole = 3e-4f;  // m^2
constexpr double kLengthShare = 0.8;   // of the strands around are no longer than a cell's length
constexpr float kNearLength = 0.04f;   // m: strands go apart by their distance over at least so much of their length
constexpr std::size_t kPathPoints = 12;
constexpr double kOneWay = 0.5;            // rad, divergence up to which a cell's strands go one way
constexpr std::size_t kGroupStrands = 12;  // of a cell, about which groups are looked for

// Cells around cell (x, y) within `reach`.
template <class Visit>
void visitAround(const RootRaster& raster, int x, int y, int reach, Visit visit) {
  for (int j = std::max(0, y - reach); j <= std::min(raster.rows - 1, y + reach); ++j)
    for (int i = std::max(0, x - reach); i <= std::min(raster.columns - 1, x + reach); ++i)
      visit(static_cast<std::size_t>(j * raster.columns + i));
}

void layRaster(const std::vector<Vector2f>& at, float size, RootRaster& raster) {
  Vector2f low = at.front(), high = at.front();
  for (const Vector2f& p : at) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr int kRasterMargin = 3;  // cells
  raster.size = size;
  // The outermost roots lie in the middle of cells: which one they are in is no matter of rounding.
  raster.origin = low.array() - (kRasterMargin + 0.5f) * size;
  raster.columns = static_cast<int>((high.x() - low.x()) / size) + 2 + 2 * kRasterMargin;
  raster.rows = static_cast<int>((high.y() - low.y()) / size) + 2 + 2 * kRasterMargin;
  raster.cells.assign(static_cast<std::size_t>(raster.columns * raster.rows), {});
  raster.cell_of.resize(at.size());
  for (std::size_t s = 0; s < at.size(); ++s) {
    raster.cell_of[s] = raster.cellAt(at[s]);
    ++raster.cells[static_cast<std::size_t>(raster.cell_of[s])].strands;
  }
}

using Path = std::vector<Vector3f>;

Path pathOf(std::span<const Vector3f> strand) {
  Path path;
  for (std::size_t k = 0; k < kPathPoints; ++k) path.push_back(strand[k * (strand.size() - 1) / (kPathPoints - 1)]);
  return path;
}

// The most of a cell's strands that go one way: those that go along with one of them.
std::vector<std::size_t> largestGroup(const std::vector<Path>& paths) {
  std::vector<std::size_t> largest;
  for (std::size_t a = 0; a < std::min(paths.size(), kGroupStrands); ++a) {
    std::vector<std::size_t> group;
    for (std::size_t b = 0; b < paths.size(); ++b)
      if (divergence(paths[a], paths[b]) < kOneWay) group.push_back(b);
    if (group.size() > largest.size()) largest = std::move(group);
  }
  return largest;
}

// Strands of two ways that root in one cell have no mean way.
void meanPaths(const StrandSamples& strands, RootRaster& raster) {
  std::vector<std::vector<Path>> paths(raster.cells.size());
  std::vector<std::vector<float>> lengths(raster.cells.size());
  for (std::size_t s = 0; s < strands.strandCount(); ++s) {
    const auto at = static_cast<std::size_t>(raster.cell_of[s]);
    RootCell& cell = raster.cells[at];
    paths[at].push_back(pathOf(strands.strand(s)));
    lengths[at].push_back(strands.length[s]);
    cell.radius += (strands.strand(s)[0] - raster.map.center).norm() / static_cast<float>(cell.strands);
  }
  for (std::size_t at = 0; at < paths.size(); ++at) {
    const std::vector<std::size_t> group = largestGroup(paths[at]);
    if (group.empty()) continue;
    Path& mean = raster.cells[at].path;
    mean.assign(kPathPoints, Vector3f::Zero());
    for (const std::size_t one : group) {
      raster.cells[at].path_strands += lengths[at][one] / static_cast<float>(group.size());
      for (std::size_t k = 0; k < kPathPoints; ++k) mean[k] += paths[at][one][k] / static_cast<float>(group.size());
    }
  }
}

// Each cell's length: a quantile over the strands of the cells around it, then evened out.
void localLengths(const StrandSamples& strands, RootRaster& raster) {
  std::vector<std::vector<float>> of(raster.cells.size());
  for (std::size_t s = 0; s < strands.strandCount(); ++s)
    of[static_cast<std::size_t>(raster.cell_of[s])].push_back(strands.length[s]);
  const int reach = 1;
  std::vector<float> lengths(raster.cells.size(), 0);
  const auto overCells = [&](auto one) {
    for (int y = 0; y < raster.rows; ++y)
      for (int x = 0; x < raster.columns; ++x) one(x, y, static_cast<std::size_t>(y * raster.columns + x));
  };
  overCells([&](int x, int y, std::size_t cell) {
    if (raster.cells[cell].path.empty()) return;
    std::vector<float> around;
    visitAround(raster, x, y, reach,
                [&](std::size_t other) { around.insert(around.end(), of[other].begin(), of[other].end()); });
    lengths[cell] = static_cast<float>(quantile(std::move(around), kLengthShare));
  });
  overCells([&](int x, int y, std::size_t cell) {
    float sum = 0, count = 0;
    visitAround(raster, x, y, reach, [&](std::size_t other) {
      if (lengths[other] <= 0) return;
      sum += lengths[other];
      ++count;
    });
    raster.cells[cell].length = count > 0 ? sum / count : 0;
  });
}

// An empty cell takes the mean of those around it.
bool fillFromNeighbours(int x, int y, RootRaster& raster, std::vector<RootCell>& out) {
  const std::size_t at = static_cast<std::size_t>(y * raster.columns + x);
  RootCell& cell = out[at];
  float count = 0;
  visitAround(raster, x, y, 1, [&](std::size_t other) {
    const RootCell& near = raster.cells[other];
    if (near.path.empty()) return;
    if (cell.path.empty()) cell.path.assign(kPathPoints, Vector3f::Zero());
    for (std::size_t k = 0; k < kPathPoints; ++k) cell.path[k] += near.path[k];
    cell.path_strands += near.path_strands;
    cell.radius += near.radius;
    ++count;
  });
  if (count == 0) return false;
  for (Vector3f& p : cell.path) p /= count;
  cell.path_strands /= count;
  cell.radius /= count;
  return true;
}

// Cells of the connected empty area around `start`; marks them in `seen`.
std::vector<int> emptyArea(const RootRaster& raster, int start, std::vector<bool>& seen) {
  std::vector<int> area{start};
  seen[static_cast<std::size_t>(start)] = true;
  for (std::size_t k = 0; k < area.size(); ++k) {
    const int x = area[k] % raster.columns, y = area[k] / raster.columns;
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int i = x + dx, j = y + dy, other = j * raster.columns + i;
      if (i < 0 || j < 0 || i >= raster.columns || j >= raster.rows) continue;
      if (seen[static_cast<std::size_t>(other)] || !raster.cells[static_cast<std::size_t>(other)].path.empty())
        continue;
      seen[static_cast<std::size_t>(other)] = true;
      area.push_back(other);
    }
  }
  return area;
}

void fillHoles(RootRaster& raster) {
  // Gaps of single cells first, twice: an empty cell that most of those around it surround.
  for (int round = 0; round < 2; ++round) {
    std::vector<RootCell> out = raster.cells;
    for (int y = 1; y + 1 < raster.rows; ++y) {
      for (int x = 1; x + 1 < raster.columns; ++x) {
        if (!raster.cells[static_cast<std::size_t>(y * raster.columns + x)].path.empty()) continue;
        int full = 0;
        visitAround(raster, x, y, 1, [&](std::size_t other) { full += raster.cells[other].path.empty() ? 0 : 1; });
        if (full >= 4) fillFromNeighbours(x, y, raster, out);
      }
    }
    raster.cells = std::move(out);
  }
  std::vector<bool> seen(raster.cells.size(), false);
  emptyArea(raster, 0, seen);
  for (int start = 0; start < static_cast<int>(seen.size()); ++start) {
    if (seen[static_cast<std::size_t>(start)] || !raster.cells[static_cast<std::size_t>(start)].path.empty()) continue;
    std::vector<int> hole = emptyArea(raster, start, seen);
    if (static_cast<float>(hole.size()) * raster.size * raster.size > kLargestHole) continue;
    while (!hole.empty()) {
      std::vector<RootCell> out = raster.cells;
      std::erase_if(hole, [&](int cell) {
        return fillFromNeighbours(cell % raster.columns, cell / raster.columns, raster, out);
      });
      raster.cells = std::move(out);
    }
  }
}

template <class Value>
float bilinear(const RootRaster& raster, const Vector2f& at, Value value) {
  const Vector2f cell = ((at - raster.origin) / raster.size).array() - 0.5f;
  const int x = static_cast<int>(std::floor(cell.x())), y = static_cast<int>(std::floor(cell.y()));
  // Over the nearest four cells that have a value, or further out until there is one.
  for (int reach = 0; reach < std::max(raster.columns, raster.rows); ++reach) {
    float sum = 0, weights = 0;
    for (int j = std::max(0, y - reach); j <= std::min(raster.rows - 1, y + 1 + reach); ++j) {
      for (int i = std::max(0, x - reach); i <= std::min(raster.columns - 1, x + 1 + reach); ++i) {
        const float one = value(raster.cells[static_cast<std::size_t>(j * raster.columns + i)]);
        if (one <= 0) continue;
        const float dx = std::abs(cell.x() - static_cast<float>(i)), dy = std::abs(cell.y() - static_cast<float>(j));
        const float weight = reach == 0 ? std::max(1e-6f, (1 - dx) * (1 - dy)) : 1 / (dx * dx + dy * dy);
        sum += weight * one;
        weights += weight;
      }
    }
    if (weights > 0) return sum / weights;
  }
  return 0;
}

}  // namespace

Vector2f ScalpMap::toMap(const Vector3f& point) const {
  const Vector3f out = (point - center).normalized();
  const Vector2f across(out.dot(axis_u), out.dot(axis_v));
  const float sine = across.norm(), angle = std::atan2(sine, out.dot(pole));
  return sine > 1e-9f ? Vector2f(radius * angle / sine * across) : Vector2f(Vector2f::Zero());
}

Vector3f ScalpMap::direction(const Vector2f& at) const {
  const float angle = at.norm() / radius;
  if (angle < 1e-9f) return pole;
  const Vector2f across = std::sin(angle) / at.norm() * at;
  return std::cos(angle) * pole + across.x() * axis_u + across.y() * axis_v;
}

ScalpMap fitScalpMap(const StrandSamples& strands) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), away = Eigen::Vector3d::Zero();
  const double count = static_cast<double>(strands.strandCount());
  for (std::size_t s = 0; s < strands.strandCount(); ++s) {
    const auto strand = strands.strand(s);
    middle += strand[0].cast<double>() / count;
    away += (strand[1] - strand[0]).cast<double>().normalized() / count;
  }
  away = away.norm() > 1e-6 ? away.normalized() : Eigen::Vector3d::UnitY();
  // |p|^2 - 2 c . p + (|c|^2 - r^2) = 0 about the middle, with a weak wish for a head's size under the roots.
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (std::size_t s = 0; s < strands.strandCount(); ++s) {
    const Eigen::Vector3d p = strands.strand(s)[0].cast<double>() - middle;
    const Eigen::Vector4d row(2 * p.x(), 2 * p.y(), 2 * p.z(), 1);
    normal += row * row.transpose() / count;
    right += row * p.squaredNorm() / count;
  }
  const double prior = 2e-5;
  const Eigen::Vector3d wished = -kHeadRadius * away;
  normal.topLeftCorner<3, 3>() += prior * Eigen::Matrix3d::Identity();
  right.head<3>() += prior * wished;
  const Eigen::Vector4d fit = normal.ldlt().solve(right);
  ScalpMap map;
  map.center = (middle + fit.head<3>()).cast<float>();
  Vector3f pole = Vector3f::Zero();
  double radius = 0;
  for (std::size_t s = 0; s < strands.strandCount(); ++s) {
    const Vector3f out = strands.strand(s)[0] - map.center;
    radius += out.norm() / count;
    pole += out.normalized();
  }
  map.radius = static_cast<float>(radius);
  map.pole = pole.norm() > 1e-6f ? pole.normalized() : Vector3f(away.cast<float>());
  map.axis_u = map.pole.cross(Vector3f(0, 0, 1)).norm() > 0.1f ? map.pole.cross(Vector3f(0, 0, 1)).normalized()
                                                               : map.pole.unitOrthogonal();
  map.axis_v = map.pole.cross(map.axis_u);
  return map;
}

int RootRaster::cellAt(const Vector2f& at) const {
  const int x = std::clamp(static_cast<int>((at.x() - origin.x()) / size), 0, columns - 1);
  const int y = std::clamp(static_cast<int>((at.y() - origin.y()) / size), 0, rows - 1);
  return y * columns + x;
}

float RootRaster::radiusAt(const Vector2f& at) const {
  return bilinear(*this, at, [](const RootCell& cell) { return cell.radius; });
}

float RootRaster::lengthAt(const Vector2f& at) const {
  return bilinear(*this, at, [](const RootCell& cell) { return cell.length; });
}

Vector3f RootRaster::skinAt(const Vector2f& at) const {
  return map.center + radiusAt(at) * map.direction(at);
}

double divergence(const std::vector<Vector3f>& a, const std::vector<Vector3f>& b) {
  const float apart = (a.front() - b.front()).norm();
  float most = 0, along = 0;
  for (std::size_t k = 1; k < a.size(); ++k) {
    along += 0.5f * ((a[k] - a[k - 1]).norm() + (b[k] - b[k - 1]).norm());
    most = std::max(most, ((a[k] - b[k]).norm() - apart) / std::max(along, kNearLength));
  }
  return most;
}

RootRaster rasterRoots(const StrandSamples& strands) {
  RootRaster raster;
  raster.map = fitScalpMap(strands);
  std::vector<Vector2f> at;
  for (std::size_t s = 0; s < strands.strandCount(); ++s) at.push_back(raster.map.toMap(strands.strand(s)[0]));
  const float largest = kLargestCell * std::max(1.0f, raster.map.radius / static_cast<float>(kHeadRadius));
  for (float size = kSmallestCell;; size *= 1.25f) {
    layRaster(at, size, raster);
    const auto full =
        std::count_if(raster.cells.begin(), raster.cells.end(), [](const RootCell& c) { return c.strands > 0; });
    if (size >= largest || static_cast<double>(full) * kStrandsPerCell <= static_cast<double>(at.size())) break;
  }
  meanPaths(strands, raster);
  fillHoles(raster);
  localLengths(strands, raster);
  return raster;
}

}  // namespace app
