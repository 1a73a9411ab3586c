#include "app/groom/fit/root_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace app {
namespace {

using Eigen::Vector2f;

constexpr float kHexArea = 0.8660254f;  // of a point's share, in squares of the spacing
constexpr int kLloydSteps = 12;
constexpr int kSmoothing = 4;       // steps along the rim on either side
constexpr float kRimShare = 0.55f;  // of the spacing that points inside keep off the rim
constexpr float kSliver = 0.12f;    // smallest height of a triangle over the spacing

// A closed walk along the edges of cells with the region on its left.
using Loop = std::vector<int>;  // corners

struct Rims {
  const RootRaster& raster;
  int across() const { return raster.columns + 1; }
  // The region right of the step from a corner in one of four directions (+x, +y, -x, -y), and left of it.
  std::array<int, 2> besides(int corner, int direction) const {
    const int x = corner % across(), y = corner / across();
    switch (direction) {
      case 0:
        return {raster.regionAt(x, y - 1), raster.regionAt(x, y)};
      case 1:
        return {raster.regionAt(x, y), raster.regionAt(x - 1, y)};
      case 2:
        return {raster.regionAt(x - 1, y), raster.regionAt(x - 1, y - 1)};
      default:
        return {raster.regionAt(x - 1, y - 1), raster.regionAt(x, y - 1)};
    }
  }
  int step(int corner, int direction) const {
    const std::array<int, 4> way{1, across(), -1, -across()};
    return corner + way[static_cast<std::size_t>(direction)];
  }
  std::vector<Loop> loops(int region) const;
  // The number of the regions around a corner, the outside counted as one.
  int meeting(int corner) const {
    const int x = corner % across(), y = corner / across();
    return static_cast<int>(std::set<int>{raster.regionAt(x, y), raster.regionAt(x - 1, y), raster.regionAt(x, y - 1),
                                          raster.regionAt(x - 1, y - 1)}
                                .size());
  }
};

std::vector<Loop> Rims::loops(int region) const {
  std::set<std::pair<int, int>> seen;  // corner and direction
  std::vector<Loop> all;
  for (int corner = 0; corner < across() * (raster.rows + 1); ++corner) {
    for (int first = 0; first < 4; ++first) {
      const auto isRim = [&](int at, int direction) {
        const auto [right, left] = besides(at, direction);
        return left == region && right != region;
      };
      if (!isRim(corner, first) || seen.contains({corner, first})) continue;
      Loop loop;
      for (int at = corner, direction = first; seen.insert({at, direction}).second;) {
        loop.push_back(at);
        at = step(at, direction);
        // The leftmost turn that keeps the region on the left: cells that touch at a corner stay apart.
        for (int turn : {1, 0, 3}) {
          if (!isRim(at, (direction + turn) % 4)) continue;
          direction = (direction + turn) % 4;
          break;
        }
      }
      all.push_back(std::move(loop));
    }
  }
  return all;
}

// Lengths are cells until the mesh is done: points on the lattice are as far apart as others to the last bit, and which
// is taken must not hang on the rounding of the map.
Vector2f cornerAt(const RootRaster& raster, int corner) {
  const int across = raster.columns + 1;
  return {static_cast<float>(corner % across), static_cast<float>(corner / across)};
}

// Points along all rims. A corner of the raster carries one point, that all regions around it share unless it is split.
struct RimPoints {
  std::map<int, Vector2f> kept;              // by corner
  std::vector<std::vector<int>> corners_of;  // per region
};

Vector2f smoothed(const RootRaster& raster, const Loop& loop, std::size_t at) {
  const int count = static_cast<int>(loop.size()), reach = std::min(kSmoothing, count / 8);
  Vector2f sum = Vector2f::Zero();
  for (int d = -reach; d <= reach; ++d)
    sum += cornerAt(raster, loop[static_cast<std::size_t>((static_cast<int>(at) + d + count) % count)]);
  return sum / static_cast<float>(2 * reach + 1);
}

void keepAlong(const Rims& rims, const Loop& loop, int region, float spacing, RimPoints& points) {
  const RootRaster& raster = rims.raster;
  const std::size_t count = loop.size();
  const auto otherSide = [&](std::size_t k) {
    const int from = loop[k], to = loop[(k + 1) % count];
    for (int direction = 0; direction < 4; ++direction)
      if (rims.step(from, direction) == to) return rims.besides(from, direction)[0];
    return -1;
  };
  // Junctions first; stretches along a region that was walked before have their points already.
  for (std::size_t k = 0; k < count; ++k) {
    if (rims.meeting(loop[k]) >= 3) points.kept.try_emplace(loop[k], cornerAt(raster, loop[k]));
  }
  std::size_t start = 0;
  while (start < count && !points.kept.contains(loop[start])) ++start;
  if (start == count) {
    start = 0;
    points.kept.try_emplace(loop[0], smoothed(raster, loop, 0));
  }
  for (std::size_t from = 0; from < count;) {
    std::size_t to = from + 1;
    while (to < count && !points.kept.contains(loop[(start + to) % count])) ++to;
    const int beside = otherSide((start + from) % count);
    const float length = static_cast<float>(to - from) * 0.8f;  // stairs are longer than the line
    int parts = std::max(to - from == count ? 4 : 1, static_cast<int>(std::lround(length / spacing)));
    parts = std::min(parts, static_cast<int>(to - from));
    if (beside >= 0 && beside < region) parts = 1;
    for (int part = 1; part < parts; ++part) {
      const std::size_t at =
          (start + from + (to - from) * static_cast<std::size_t>(part) / static_cast<std::size_t>(parts)) % count;
      points.kept.try_emplace(loop[at], smoothed(raster, loop, at));
    }
    from = to;
  }
  std::vector<int>& own = points.corners_of[static_cast<std::size_t>(region)];
  for (std::size_t k = 0; k < count; ++k) {
    if (points.kept.contains(loop[k])) own.push_back(loop[k]);
  }
}

struct Interior {
  std::vector<Vector2f> cells;  // centres of the region's cells
  std::vector<Vector2f> fixed, free;
};

std::size_t nearestOf(const Vector2f& p, const std::vector<Vector2f>& points, float& squared) {
  std::size_t best = points.size();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const float one = (points[k] - p).squaredNorm();
    if (one >= squared) continue;
    squared = one;
    best = k;
  }
  return best;
}

// Farthest points first, then Lloyd's steps with the rim's points held.
void spreadInside(int count, float spacing, Interior& in) {
  std::vector<float> far(in.cells.size());
  for (std::size_t c = 0; c < far.size(); ++c) {
    far[c] = std::numeric_limits<float>::infinity();
    nearestOf(in.cells[c], in.fixed, far[c]);
  }
  for (int k = 0; k < count; ++k) {
    const auto best = std::max_element(far.begin(), far.end());
    if (best == far.end() || *best < kRimShare * kRimShare * spacing * spacing) break;
    in.free.push_back(in.cells[static_cast<std::size_t>(best - far.begin())]);
    for (std::size_t c = 0; c < far.size(); ++c)
      far[c] = std::min(far[c], (in.cells[c] - in.free.back()).squaredNorm());
  }
  for (int step = 0; step < kLloydSteps; ++step) {
    std::vector<Vector2f> sum(in.free.size(), Vector2f::Zero());
    std::vector<int> cells(in.free.size(), 0);
    for (const Vector2f& p : in.cells) {
      float squared = std::numeric_limits<float>::infinity();
      nearestOf(p, in.fixed, squared);
      const std::size_t nearest = nearestOf(p, in.free, squared);
      if (nearest == in.free.size()) continue;
      sum[nearest] += p;
      ++cells[nearest];
    }
    for (std::size_t k = 0; k < in.free.size(); ++k)
      if (cells[k] > 0) in.free[k] = sum[k] / static_cast<float>(cells[k]);
  }
}

bool insideRegion(const RootRaster& raster, int region, const Vector2f& p) {
  return raster.regionAt(static_cast<int>(p.x()), static_cast<int>(p.y())) == region;
}

bool belongs(const RootRaster& raster, int region, float spacing, const Vector2f& a, const Vector2f& b,
             const Vector2f& c) {
  const Vector2f ab = b - a, ac = c - a, bc = c - b;
  const float twice = ab.x() * ac.y() - ab.y() * ac.x();
  const float longest = std::max({ab.norm(), ac.norm(), bc.norm()});
  if (twice / longest < kSliver * std::min(spacing, longest)) return false;
  int inside = 0;
  for (const auto& [wb, wc] : {std::pair{1.0f, 1.0f}, {4.0f, 1.0f}, {1.0f, 4.0f}, {0.25f, 0.25f}}) {
    const Vector2f weights(wb, wc);
    const float sum = 1 + weights.x() + weights.y();
    inside += insideRegion(raster, region, (a + weights.x() * b + weights.y() * c) / sum) ? 1 : 0;
  }
  return inside >= 3;
}

// Columns of one attempt with a given spacing.
RootMesh meshWith(const RootRaster& raster, float spacing) {
  const Rims rims{raster};
  RimPoints points;
  points.corners_of.resize(static_cast<std::size_t>(raster.regions));
  for (int r = 0; r < raster.regions; ++r) {
    for (const Loop& loop : rims.loops(r)) keepAlong(rims, loop, r, spacing, points);
  }
  RootMesh mesh;
  std::map<std::pair<int, int>, int> column_of;  // corner and region, or -1 for all regions
  for (int r = 0; r < raster.regions; ++r) {
    Interior in;
    std::vector<int> columns;
    std::vector<int>& corners = points.corners_of[static_cast<std::size_t>(r)];
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (int corner : corners) {
      const bool split = raster.split[static_cast<std::size_t>(corner)] != 0;
      const auto [entry, added] = column_of.try_emplace({corner, split ? r : -1}, static_cast<int>(mesh.at.size()));
      if (added) mesh.at.push_back(points.kept.at(corner));
      columns.push_back(entry->second);
      in.fixed.push_back(points.kept.at(corner));
    }
    for (int y = 0; y < raster.rows; ++y)
      for (int x = 0; x < raster.columns; ++x)
        if (raster.regionAt(x, y) == r)
          in.cells.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const float area = static_cast<float>(in.cells.size());
    const float inside = area - 0.5f * spacing * spacing * static_cast<float>(in.fixed.size());
    spreadInside(static_cast<int>(std::max(0.0f, inside / (kHexArea * spacing * spacing))), spacing, in);
    for (const Vector2f& p : in.free) {
      columns.push_back(static_cast<int>(mesh.at.size()));
      mesh.at.push_back(p);
    }
    in.fixed.insert(in.fixed.end(), in.free.begin(), in.free.end());
    for (const std::array<int, 3>& t : delaunay(in.fixed)) {
      const auto point = [&](int k) { return in.fixed[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
      if (!belongs(raster, r, spacing, point(0), point(1), point(2))) continue;
      std::array<int, 3>& out = mesh.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) out[k] = columns[static_cast<std::size_t>(t[k])];
      mesh.region.push_back(r);
    }
  }
  return mesh;
}

// Leaves out triangles with an edge that another one has already, in the same direction.
void dropDoubled(RootMesh& mesh) {
  std::set<std::pair<int, int>> taken;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> region;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<int, 3>& triangle = mesh.triangles[t];
    bool free = true;
    for (std::size_t k = 0; k < 3; ++k) free = free && !taken.contains({triangle[k], triangle[(k + 1) % 3]});
    if (!free) continue;
    for (std::size_t k = 0; k < 3; ++k) taken.insert({triangle[k], triangle[(k + 1) % 3]});
    triangles.push_back(triangle);
    region.push_back(mesh.region[t]);
  }
  mesh.triangles = std::move(triangles);
  mesh.region = std::move(region);
}

// Leaves out columns that no triangle uses.
void dropUnused(RootMesh& mesh) {
  std::vector<int> number(mesh.at.size(), -1);
  std::vector<Vector2f> used;
  for (auto& triangle : mesh.triangles) {
    for (int& column : triangle) {
      int& to = number[static_cast<std::size_t>(column)];
      if (to < 0) {
        to = static_cast<int>(used.size());
        used.push_back(mesh.at[static_cast<std::size_t>(column)]);
      }
      column = to;
    }
  }
  mesh.at = std::move(used);
}

}  // namespace

std::vector<std::array<int, 3>> delaunay(const std::vector<Vector2f>& given) {
  using Point = Eigen::Vector2d;
  std::vector<Point> points;
  Point middle = Point::Zero();
  double reach = 1e-9;
  for (std::size_t k = 0; k < given.size(); ++k) {
    // A hair's breadth of disorder: no four points on one circle.
    const double angle = 2.399963 * static_cast<double>(k);
    points.push_back(given[k].cast<double>() + 1e-6 * Point(std::cos(angle), std::sin(angle)));
    middle += points.back() / static_cast<double>(given.size());
  }
  for (const Point& p : points) reach = std::max(reach, (p - middle).norm());
  const int count = static_cast<int>(points.size());
  for (int k = 0; k < 3; ++k) {
    const double angle = 2.0943951 * k;
    points.push_back(middle + 1e3 * reach * Point(std::cos(angle), std::sin(angle)));
  }
  std::vector<std::array<int, 3>> triangles{{count, count + 1, count + 2}};
  const auto at = [&](int k) { return points[static_cast<std::size_t>(k)]; };
  for (int k = 0; k < count; ++k) {
    std::map<std::pair<int, int>, int> edges;
    std::erase_if(triangles, [&](const std::array<int, 3>& t) {
      Eigen::Matrix3d m;
      for (int i = 0; i < 3; ++i) {
        const Point d = at(t[static_cast<std::size_t>(i)]) - at(k);
        m.row(i) << d.x(), d.y(), d.squaredNorm();
      }
      if (m.determinant() <= 0) return false;
      for (std::size_t i = 0; i < 3; ++i) edges[{t[i], t[(i + 1) % 3]}] = 1;
      return true;
    });
    for (const auto& [edge, one] : edges)
      if (!edges.contains({edge.second, edge.first})) triangles.push_back({edge.first, edge.second, k});
  }
  std::erase_if(triangles, [&](const auto& t) { return std::max({t[0], t[1], t[2]}) >= count; });
  return triangles;
}

RootMesh meshRoots(const RootRaster& raster, int columns) {
  float low = 0.3f, high = static_cast<float>(std::max(raster.columns, raster.rows));
  RootMesh best;
  for (int round = 0; round < 12; ++round) {
    const float spacing = std::sqrt(low * high);
    RootMesh mesh = meshWith(raster, spacing);
    dropDoubled(mesh);
    dropUnused(mesh);
    if (static_cast<int>(mesh.at.size()) > columns) {
      low = spacing;
      if (best.at.empty() || best.at.size() > mesh.at.size()) best = std::move(mesh);
    } else {
      high = spacing;
      if (best.triangles.empty() || best.at.size() < mesh.at.size() || static_cast<int>(best.at.size()) > columns)
        if (!mesh.triangles.empty()) best = std::move(mesh);
    }
  }
  for (Vector2f& at : best.at) at = raster.origin + raster.size * at;
  return best;
}

namespace {

float distanceToEdge(const Vector2f& p, const Vector2f& a, const Vector2f& b) {
  const Vector2f ab = b - a;
  const float share = std::clamp((p - a).dot(ab) / std::max(ab.squaredNorm(), 1e-12f), 0.0f, 1.0f);
  return (p - a - share * ab).norm();
}

}  // namespace

int faceAt(const RootMesh& mesh, int region, const Vector2f& p) {
  int best = -1;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (region >= 0 && mesh.region[t] != region) continue;
    const auto corner = [&](std::size_t k) { return mesh.at[static_cast<std::size_t>(mesh.triangles[t][k % 3])]; };
    bool inside = true;
    float far = std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector2f a = corner(k), b = corner(k + 1), ab = b - a, ap = p - a;
      inside = inside && ab.x() * ap.y() - ab.y() * ap.x() >= 0;
      far = std::min(far, distanceToEdge(p, a, b));
    }
    if (inside) return static_cast<int>(t);
    if (far >= least) continue;
    least = far;
    best = static_cast<int>(t);
  }
  return best >= 0 || region < 0 ? best : faceAt(mesh, -1, p);
}

}  // namespace app
