#include "app/groom/strips/strip_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "app/groom/strips/strip_ends.h"

namespace app {

Eigen::Vector3d middleOf(const std::vector<Eigen::Vector3d>& row) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : row) sum += p;
  return sum / static_cast<double>(row.size());
}

double lineLength(const StripRows& strip) {
  double length = 0;
  for (std::size_t r = 1; r < strip.rows.size(); ++r)
    length += (middleOf(strip.rows[r]) - middleOf(strip.rows[r - 1])).norm();
  return length;
}

namespace {

using Eigen::Vector3d;
using Row = std::vector<Vector3d>;

constexpr double kFlatCap = 0.35;     // of a ring's radius: a single vertex no further from its plane closes it
constexpr double kOpened = 0.2;       // of its neighbour's width: what a pointed row is opened to
constexpr double kMinFollowed = 0.6;  // of the rows: with fewer the piece is refused
constexpr std::size_t kMaxSides = 256;

std::vector<int> levelsFrom(const StripPatch& patch, const StripEnds& ends) {
  std::vector<int> level(patch.at.size(), -1), open = ends.root;
  for (const int v : open) level[static_cast<std::size_t>(v)] = 0;
  for (std::size_t k = 0; k < open.size(); ++k) {
    for (const int w : patch.neighbours[static_cast<std::size_t>(open[k])]) {
      if (level[static_cast<std::size_t>(w)] >= 0 || ends.left_out[static_cast<std::size_t>(w)]) continue;
      level[static_cast<std::size_t>(w)] = level[static_cast<std::size_t>(open[k])] + 1;
      open.push_back(w);
    }
  }
  return level;
}

// Per row: its vertices, and the edges between them that a face to another row has. Edges inside a cap are none.
struct Levels {
  std::vector<std::vector<int>> vertices;
  std::vector<std::map<int, std::set<int>>> beside;
};

Levels gatherLevels(const StripPatch& patch, const StripEnds& ends) {
  const std::vector<int> level = levelsFrom(patch, ends);
  Levels out;
  const int last = *std::max_element(level.begin(), level.end());
  out.vertices.resize(static_cast<std::size_t>(last + 1));
  out.beside.resize(static_cast<std::size_t>(last + 1));
  for (std::size_t v = 0; v < level.size(); ++v) {
    if (level[v] >= 0) out.vertices[static_cast<std::size_t>(level[v])].push_back(static_cast<int>(v));
  }
  for (const std::vector<int>& face : patch.faces) {
    const auto of = [&](std::size_t k) { return level[static_cast<std::size_t>(face[k % face.size()])]; };
    bool spans = false;
    for (std::size_t k = 0; k < face.size(); ++k) spans = spans || of(k) != of(0);
    if (!spans) continue;
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (of(k) < 0 || of(k) != of(k + 1)) continue;
      auto& beside = out.beside[static_cast<std::size_t>(of(k))];
      const int a = face[k], b = face[(k + 1) % face.size()];
      beside[a].insert(b);
      beside[b].insert(a);
    }
  }
  return out;
}

// The vertices of a row in order; empty where they are no single chain, or of a tube no single ring.
std::vector<int> orderedRow(const Levels& levels, std::size_t row, bool tube) {
  const std::vector<int>& vertices = levels.vertices[row];
  const auto& beside = levels.beside[row];
  if (vertices.size() == 1) return vertices;
  if (beside.size() != vertices.size()) return {};
  int start = vertices.front(), ends = 0;
  for (const auto& [v, others] : beside) {
    if (others.size() > 2) return {};
    if (others.size() == 1) {
      if (ends++ == 0) start = v;
    }
  }
  if (ends != (tube ? 0 : 2)) return {};
  std::vector<int> order{start};
  int before = -1;
  while (order.size() < vertices.size()) {
    const int here = order.back();
    int next = -1;
    for (const int v : beside.at(here)) {
      if (v != before && v != order.front()) next = v;
    }
    if (next < 0) return {};  // a shorter ring or chain: the row is in pieces
    before = here;
    order.push_back(next);
  }
  return order;
}

Row placesOf(const StripPatch& patch, const std::vector<int>& order) {
  Row row;
  for (const int v : order) row.push_back(patch.at[static_cast<std::size_t>(v)]);
  return row;
}

// `count` points at even steps of the index along a chain, or round a ring from its first point.
Row withPoints(const Row& row, std::size_t count, bool ring) {
  if (row.size() == count || row.size() == 1) return row;
  Row out;
  const auto steps = static_cast<double>(ring ? count : count - 1);
  const auto length = static_cast<double>(ring ? row.size() : row.size() - 1);
  for (std::size_t k = 0; k < count; ++k) {
    const double at = length * static_cast<double>(k) / steps;
    const std::size_t before = std::min(row.size() - 1, static_cast<std::size_t>(at));
    const double share = at - static_cast<double>(before);
    const Vector3d& next = ring ? row[(before + 1) % row.size()] : row[std::min(before + 1, row.size() - 1)];
    out.push_back((1 - share) * row[before] + share * next);
  }
  return out;
}

// Turns a row so that its points follow those of the row before.
void alignRow(const Row& before, bool ring, Row& row) {
  const std::size_t n = row.size();
  if (n != before.size() || n < 2) return;
  double least = -1;
  Row best = row;
  for (const bool back : {false, true}) {
    for (std::size_t shift = 0; shift < (ring ? n : 1); ++shift) {
      Row turned(n);
      for (std::size_t k = 0; k < n; ++k) turned[k] = row[back ? (2 * n - 1 - k + shift) % n : (k + shift) % n];
      double sum = 0;
      for (std::size_t k = 0; k < n; ++k) sum += (turned[k] - before[k]).squaredNorm();
      if (least < 0 || sum < least) {
        least = sum;
        best = turned;
      }
    }
  }
  row = best;
}

bool closesFlat(const Row& ring, const Vector3d& point) {
  const Vector3d middle = middleOf(ring);
  Vector3d normal = Vector3d::Zero();
  double radius = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    normal += (ring[k] - middle).cross(ring[(k + 1) % ring.size()] - middle);
    radius += (ring[k] - middle).norm() / static_cast<double>(ring.size());
  }
  return std::abs(normal.stableNormalized().dot(point - middle)) < kFlatCap * radius;
}

// A row of one point gets the shape of its neighbour, small.
void openPoint(const Row& neighbour, Row& row) {
  const Vector3d point = row.front(), middle = middleOf(neighbour);
  row.clear();
  for (const Vector3d& p : neighbour) row.push_back(point + kOpened * (p - middle));
}

std::string finishRows(StripRows& out) {
  std::vector<Row>& rows = out.rows;
  if (out.tube && rows.size() > 2 && rows.back().size() == 1 && closesFlat(rows[rows.size() - 2], rows.back()[0]))
    rows.pop_back();
  if (rows.size() < 2) return "has no second row";
  std::size_t width = 0;
  for (const Row& row : rows) width = std::max(width, row.size());
  if (width < (out.tube ? 3u : 2u)) return "is no wider than a line";
  if (width > kMaxSides) return "is over " + std::to_string(kMaxSides) + " vertices wide";
  for (Row& row : rows) row = withPoints(row, width, out.tube);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].size() > 1 && rows[r - 1].size() > 1) alignRow(rows[r - 1], out.tube, rows[r]);
  }
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].size() == 1 && rows[r - 1].size() > 1) openPoint(rows[r - 1], rows[r]);
  }
  if (rows[0].size() == 1) openPoint(rows[1], rows[0]);
  for (const Row& row : rows) {
    if (row.size() != width) return "narrows to a point between its ends";
  }
  return "";
}

}  // namespace

std::string stripRows(const StripPatch& patch, const RootMeasure& measure, bool other_end, StripRows& out) {
  StripEnds ends;
  if (const std::string fault = findEnds(patch, measure, other_end, ends); !fault.empty()) return fault;
  const Levels levels = gatherLevels(patch, ends);
  out.tube = ends.tube;
  out.rows.clear();
  out.cut_rows = 0;
  const std::size_t count = levels.vertices.size();
  for (std::size_t r = 0; r < count; ++r) {
    const std::vector<int> order = orderedRow(levels, r, ends.tube);
    if (order.empty()) {
      out.cut_rows = static_cast<int>(count - r);
      break;
    }
    out.rows.push_back(placesOf(patch, order));
  }
  if (static_cast<double>(out.rows.size()) < kMinFollowed * static_cast<double>(count) || out.rows.size() < 2)
    return "has no rows that can be followed beyond row " + std::to_string(out.rows.size());
  return finishRows(out);
}

}  // namespace app
