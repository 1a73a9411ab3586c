#include "app/groom/strips/strip_ends.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace app {

namespace {

using Eigen::Vector3d;

constexpr double kCorner = 0.75 * std::numbers::pi;       // rad of faces: less is a corner of a card
constexpr double kCreased = 2 * std::numbers::pi - 0.35;  // rad: less is a vertex of a cap's rim, or a point
constexpr double kLevel = 0.1;                            // of a side's length: measures that differ by less are alike
constexpr double kRound = 0.5;                            // length of the mean normal about a tube's mouth, at most

const Vector3d& place(const StripPatch& patch, int v) {
  return patch.at[static_cast<std::size_t>(v)];
}

double meanMeasure(const StripPatch& patch, const std::vector<int>& vertices, const RootMeasure& measure) {
  double sum = 0;
  for (const int v : vertices) sum += measure(place(patch, v));
  return sum / static_cast<double>(vertices.size());
}

double chainLength(const StripPatch& patch, const std::vector<int>& chain) {
  double length = 0;
  for (std::size_t k = 1; k < chain.size(); ++k) length += (place(patch, chain[k]) - place(patch, chain[k - 1])).norm();
  return length;
}

Vector3d faceNormal(const StripPatch& patch, const std::vector<int>& face) {
  Vector3d area = Vector3d::Zero();
  for (std::size_t k = 1; k + 1 < face.size(); ++k)
    area += (place(patch, face[k]) - place(patch, face[0])).cross(place(patch, face[k + 1]) - place(patch, face[0]));
  return area.stableNormalized();
}

// Whether the faces about a boundary look to all sides, as about the mouth of a tube.
bool surrounds(const StripPatch& patch, const std::vector<int>& loop) {
  std::vector<bool> on(patch.at.size(), false);
  for (const int v : loop) on[static_cast<std::size_t>(v)] = true;
  Vector3d middle = Vector3d::Zero();
  for (const int v : loop) middle += place(patch, v) / static_cast<double>(loop.size());
  Vector3d sum = Vector3d::Zero();
  double count = 0;
  for (const std::vector<int>& face : patch.faces) {
    Vector3d center = Vector3d::Zero();
    double touching = 0;
    for (const int v : face) {
      center += place(patch, v) / static_cast<double>(face.size());
      touching += on[static_cast<std::size_t>(v)] ? 1 : 0;
    }
    if (touching < 2) continue;
    // Windings may be mixed: away from the mouth's middle is out.
    Vector3d normal = faceNormal(patch, face);
    if (normal.dot(center - middle) < 0) normal = -normal;
    sum += normal;
    ++count;
  }
  return count >= 3 && sum.norm() < kRound * count;
}

// The corners of a card, as places in its boundary: at most four, those of the least angle.
std::vector<std::size_t> cornersOf(const StripPatch& patch, const std::vector<int>& loop) {
  const bool quads = std::ranges::all_of(patch.faces, [](const auto& face) { return face.size() == 4; });
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (quads && patch.face_count[static_cast<std::size_t>(loop[k])] == 1) corners.push_back(k);
  }
  if (corners.size() == 4) return corners;
  corners.clear();
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (patch.angle[static_cast<std::size_t>(loop[k])] < kCorner) corners.push_back(k);
  }
  const auto sharper = [&](std::size_t a, std::size_t b) {
    return patch.angle[static_cast<std::size_t>(loop[a])] < patch.angle[static_cast<std::size_t>(loop[b])];
  };
  std::sort(corners.begin(), corners.end(), sharper);
  if (corners.size() > 4) corners.resize(4);
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Sides between corners that follow each other, corners included.
std::vector<std::vector<int>> sidesOf(const std::vector<int>& loop, const std::vector<std::size_t>& corners) {
  std::vector<std::vector<int>> sides;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    std::vector<int>& side = sides.emplace_back();
    for (std::size_t k = corners[i];; k = (k + 1) % loop.size()) {
      side.push_back(loop[k]);
      if (k == corners[(i + 1) % corners.size()] && side.size() > 1) break;
    }
  }
  return sides;
}

// Of four sides two that face each other are the ends: those one edge wide beside longer ones, else those whose
// measures differ clearly more, else the shorter ones.
std::array<std::vector<int>, 2> endsOfFour(const StripPatch& patch, const std::vector<std::vector<int>>& sides,
                                           const RootMeasure& measure) {
  std::array<double, 2> length{}, contrast{};
  std::array<bool, 2> narrow{};
  for (std::size_t pair = 0; pair < 2; ++pair) {
    length[pair] = chainLength(patch, sides[pair]) + chainLength(patch, sides[pair + 2]);
    narrow[pair] = sides[pair].size() == 2 && sides[pair + 2].size() == 2;
  }
  for (std::size_t pair = 0; pair < 2; ++pair) {
    contrast[pair] = std::abs(meanMeasure(patch, sides[pair], measure) - meanMeasure(patch, sides[pair + 2], measure)) /
                     std::max(1e-12, 0.5 * length[1 - pair]);
  }
  std::size_t ends = length[0] <= length[1] ? 0 : 1;
  const bool slender = length[ends] < 0.4 * length[1 - ends];
  if (narrow[0] != narrow[1]) {
    ends = narrow[0] ? 0 : 1;
  } else if (!slender && std::abs(contrast[0] - contrast[1]) > kLevel) {
    ends = contrast[0] > contrast[1] ? 0 : 1;
  }
  return {sides[ends], sides[ends + 2]};
}

std::string findCardEnds(const StripPatch& patch, const std::vector<std::size_t>& corners, const RootMeasure& measure,
                         bool other_end, StripEnds& out) {
  const std::vector<std::vector<int>> sides = sidesOf(patch.loops[0], corners);
  std::array<std::vector<int>, 2> ends;
  if (sides.size() == 4) {
    ends = endsOfFour(patch, sides, measure);
  } else {
    // Drawn to a point or rounded at one end: the shortest side, and what is farthest from it on the boundary.
    std::size_t shortest = 0;
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (chainLength(patch, sides[i]) < chainLength(patch, sides[shortest])) shortest = i;
    }
    ends[0] = sides[shortest];
    const std::vector<int>& next = sides[(shortest + 1) % sides.size()];
    ends[1] = {sides.size() == 3 ? next.back() : next[next.size() / 2]};
  }
  const bool first = meanMeasure(patch, ends[0], measure) <= meanMeasure(patch, ends[1], measure);
  out.root = ends[first != other_end ? 0 : 1];
  return "";
}

std::vector<double> distancesFrom(const StripPatch& patch, const std::vector<int>& start) {
  std::vector<double> distance(patch.at.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<std::pair<double, int>> open;
  for (const int v : start) {
    distance[static_cast<std::size_t>(v)] = 0;
    open.emplace(0.0, v);
  }
  while (!open.empty()) {
    const auto [minus, v] = open.top();
    open.pop();
    if (-minus > distance[static_cast<std::size_t>(v)]) continue;
    for (const int w : patch.neighbours[static_cast<std::size_t>(v)]) {
      const double next = -minus + (place(patch, w) - place(patch, v)).norm();
      if (next < distance[static_cast<std::size_t>(w)]) {
        distance[static_cast<std::size_t>(w)] = next;
        open.emplace(-next, w);
      }
    }
  }
  return distance;
}

int farthest(const StripPatch& patch, const std::vector<int>& start) {
  const std::vector<double> distance = distancesFrom(patch, start);
  return static_cast<int>(std::max_element(distance.begin(), distance.end()) - distance.begin());
}

// The rim of the cap that a vertex lies on or inside of: creased vertices that hang together. A point is its own rim.
std::vector<int> rimAt(const StripPatch& patch, int start, const std::vector<bool>& boundary,
                       std::vector<bool>& left_out) {
  const auto creased = [&](int v) {
    return !boundary[static_cast<std::size_t>(v)] && patch.angle[static_cast<std::size_t>(v)] < kCreased;
  };
  if (!creased(start)) {
    for (const int v : patch.neighbours[static_cast<std::size_t>(start)]) {
      if (creased(v)) {
        start = v;
        break;
      }
    }
  }
  if (!creased(start)) return {start};
  std::vector<int> rim{start};
  std::vector<bool> on(patch.at.size(), false);
  on[static_cast<std::size_t>(start)] = true;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    for (const int v : patch.neighbours[static_cast<std::size_t>(rim[k])]) {
      if (!creased(v) || on[static_cast<std::size_t>(v)]) continue;
      on[static_cast<std::size_t>(v)] = true;
      rim.push_back(v);
    }
  }
  for (std::size_t v = 0; v < patch.at.size(); ++v) {
    const std::vector<int>& around = patch.neighbours[v];
    if (!on[v] && !around.empty() &&
        std::ranges::all_of(around, [&](int w) { return on[static_cast<std::size_t>(w)]; }))
      left_out[v] = true;
  }
  return rim;
}

std::string findTubeEnds(const StripPatch& patch, const RootMeasure& measure, bool other_end, StripEnds& out) {
  if (patch.loops.size() > 2) return "branches: it has " + std::to_string(patch.loops.size()) + " openings";
  std::vector<bool> boundary(patch.at.size(), false);
  for (const auto& loop : patch.loops)
    for (const int v : loop) boundary[static_cast<std::size_t>(v)] = true;
  std::array<std::vector<int>, 2> ends;
  if (patch.loops.size() == 2) {
    ends = {patch.loops[0], patch.loops[1]};
  } else if (patch.loops.size() == 1) {
    ends = {patch.loops[0], rimAt(patch, farthest(patch, patch.loops[0]), boundary, out.left_out)};
  } else {
    const int one = farthest(patch, {0}), other = farthest(patch, {one});
    ends = {rimAt(patch, one, boundary, out.left_out), rimAt(patch, other, boundary, out.left_out)};
  }
  const bool first = meanMeasure(patch, ends[0], measure) <= meanMeasure(patch, ends[1], measure);
  out.root = ends[first != other_end ? 0 : 1];
  return "";
}

}  // namespace

std::string findEnds(const StripPatch& patch, const RootMeasure& measure, bool other_end, StripEnds& out) {
  out.left_out.assign(patch.at.size(), false);
  if (!patch.simple) return "is no plain strip or tube: edges of three faces, or boundaries that touch";
  if (patch.loops.size() == 1) {
    const std::vector<std::size_t> corners = cornersOf(patch, patch.loops[0]);
    if (corners.size() >= 2 && !(corners.size() == 2 && surrounds(patch, patch.loops[0])))
      return findCardEnds(patch, corners, measure, other_end, out);
    if (!surrounds(patch, patch.loops[0])) return "has no corners that tell where it begins";
  }
  out.tube = true;
  return findTubeEnds(patch, measure, other_end, out);
}

}  // namespace app
