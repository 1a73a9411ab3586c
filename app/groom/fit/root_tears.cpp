#include "app/groom/fit/root_tears.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <queue>

namespace app {
namespace {

constexpr double kBack = 40;              // what a step back along the tear costs; where hair is alike a step costs 20
constexpr float kShortestTear = 0.02f;    // m
constexpr int kBeside = 2;                // cells that the hair beside a tear is blurred over
constexpr double kLine = 2.7;             // edges a step up to which hair goes apart along a line, not about a point
constexpr double kSmallestRegion = 0.04;  // of all cells

// Edges and corners of the cells. Edge 2 * cell + 0 lies between a cell and the next one in x, + 1 in y.
struct Lattice {
  RootRaster& raster;
  std::vector<double> apart;  // per edge: rad; negative where a side is empty
  std::vector<bool> torn;     // per edge

  int across() const { return raster.columns + 1; }
  int cornerCount() const { return across() * (raster.rows + 1); }
  bool isFull(int x, int y) const {
    return x >= 0 && y >= 0 && x < raster.columns && y < raster.rows &&
           !raster.cells[static_cast<std::size_t>(y * raster.columns + x)].path.empty();
  }
  std::array<int, 2> ends(int edge) const {
    const int x = edge / 2 % raster.columns, y = edge / 2 / raster.columns;
    const int far = (y + 1) * across() + x + 1;
    return {edge % 2 == 0 ? far - across() : far - 1, far};
  }
  // The four edges at a corner, -1 where there is none: left, below, right, above.
  std::array<int, 4> edgesAt(int corner) const {
    const int x = corner % across(), y = corner / across();
    const auto edge = [&](int cx, int cy, int axis) {
      return cx < 0 || cy < 0 || cx >= raster.columns || cy >= raster.rows ? -1 : 2 * (cy * raster.columns + cx) + axis;
    };
    return {edge(x - 1, y - 1, 1), edge(x - 1, y - 1, 0), edge(x, y - 1, 1), edge(x - 1, y, 0)};
  }
  bool atRim(int corner) const {
    const int x = corner % across(), y = corner / across();
    return !isFull(x, y) || !isFull(x - 1, y) || !isFull(x, y - 1) || !isFull(x - 1, y - 1);
  }
};

Lattice measure(RootRaster& raster) {
  Lattice lattice{raster, std::vector<double>(2 * raster.cells.size(), -1), {}};
  for (int y = 0; y < raster.rows; ++y) {
    for (int x = 0; x < raster.columns; ++x) {
      const std::size_t cell = static_cast<std::size_t>(y * raster.columns + x);
      for (int axis = 0; axis < 2; ++axis) {
        if (!lattice.isFull(x, y) || !lattice.isFull(x + 1 - axis, y + axis)) continue;
        const std::size_t other = cell + static_cast<std::size_t>(axis == 0 ? 1 : raster.columns);
        lattice.apart[2 * cell + static_cast<std::size_t>(axis)] =
            divergence(raster.cells[cell].path, raster.cells[other].path);
      }
    }
  }
  lattice.torn.assign(lattice.apart.size(), false);
  return lattice;
}

// Steps along the chain's edges from a corner to all others; -1 off the chain.
std::vector<int> stepsFrom(const Lattice& lattice, const std::vector<bool>& chain, int from) {
  std::vector<int> steps(static_cast<std::size_t>(lattice.cornerCount()), -1);
  std::vector<int> queue{from};
  steps[static_cast<std::size_t>(from)] = 0;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    for (int edge : lattice.edgesAt(queue[k])) {
      if (edge < 0 || !chain[static_cast<std::size_t>(edge)]) continue;
      for (int corner : lattice.ends(edge)) {
        int& reached = steps[static_cast<std::size_t>(corner)];
        if (reached >= 0) continue;
        reached = steps[static_cast<std::size_t>(queue[k])] + 1;
        queue.push_back(corner);
      }
    }
  }
  return steps;
}

// Marks the corners that are near others.
std::vector<bool> cornersBeside(const Lattice& lattice, const std::vector<int>& steps) {
  std::vector<bool> beside(steps.size(), false);
  const int across = lattice.across(), down = static_cast<int>(steps.size()) / across;
  for (int corner = 0; corner < static_cast<int>(steps.size()); ++corner) {
    if (steps[static_cast<std::size_t>(corner)] < 0) continue;
    const int x = corner % across, y = corner / across;
    for (int j = std::max(0, y - kBeside); j <= std::min(down - 1, y + kBeside); ++j)
      for (int i = std::max(0, x - kBeside); i <= std::min(across - 1, x + kBeside); ++i)
        beside[static_cast<std::size_t>(j * across + i)] = true;
  }
  return beside;
}

// Whether a chain is a line: about a whorl hair goes apart all ways, by no more than its roots are apart.
bool isLine(const Lattice& lattice, const std::vector<bool>& chain, const std::vector<int>& steps, int length) {
  int ends = 0;
  for (std::size_t corner = 0; corner < steps.size(); ++corner) {
    if (steps[corner] < 0) continue;
    for (int edge : lattice.edgesAt(static_cast<int>(corner)))
      ends += edge >= 0 && chain[static_cast<std::size_t>(edge)] ? 1 : 0;
  }
  return 0.5 * ends <= kLine * length;
}

int farthest(const std::vector<int>& steps) {
  return static_cast<int>(std::max_element(steps.begin(), steps.end()) - steps.begin());
}

// Tears on from a corner to the rim, where the hair differs most, rather not along the corners that `avoided` marks.
void tearOn(Lattice& lattice, int from, const std::vector<bool>& avoided) {
  const std::size_t count = static_cast<std::size_t>(lattice.cornerCount());
  std::vector<double> cost(count, std::numeric_limits<double>::infinity());
  std::vector<int> came(count, -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[static_cast<std::size_t>(from)] = 0;
  queue.push({0, from});
  while (!queue.empty()) {
    const auto [so_far, corner] = queue.top();
    queue.pop();
    if (so_far > cost[static_cast<std::size_t>(corner)]) continue;
    if (lattice.atRim(corner)) {
      for (int at = corner; at != from;) {
        const int edge = came[static_cast<std::size_t>(at)];
        lattice.torn[static_cast<std::size_t>(edge)] = true;
        const std::array<int, 2> ends = lattice.ends(edge);
        at = ends[0] == at ? ends[1] : ends[0];
      }
      return;
    }
    for (int edge : lattice.edgesAt(corner)) {
      if (edge < 0 || lattice.apart[static_cast<std::size_t>(edge)] < 0) continue;
      const std::array<int, 2> ends = lattice.ends(edge);
      const int next = ends[0] == corner ? ends[1] : ends[0];
      const double step =
          avoided[static_cast<std::size_t>(next)] ? kBack : 1 / (0.05 + lattice.apart[static_cast<std::size_t>(edge)]);
      if (so_far + step >= cost[static_cast<std::size_t>(next)]) continue;
      cost[static_cast<std::size_t>(next)] = so_far + step;
      came[static_cast<std::size_t>(next)] = edge;
      queue.push({so_far + step, next});
    }
  }
}

// Tears where the hair goes apart by `tears` (rad) over a long enough line, and on to the rim from both its ends.
void tearChains(double tears, Lattice& lattice) {
  RootRaster& raster = lattice.raster;
  std::vector<bool> chain(lattice.apart.size());
  for (std::size_t e = 0; e < chain.size(); ++e) chain[e] = lattice.apart[e] > tears;
  std::vector<bool> done(static_cast<std::size_t>(lattice.cornerCount()), false);
  raster.split.assign(done.size(), 0);
  for (std::size_t e = 0; e < chain.size(); ++e) {
    if (!chain[e] || done[static_cast<std::size_t>(lattice.ends(static_cast<int>(e))[0])]) continue;
    const int one = farthest(stepsFrom(lattice, chain, lattice.ends(static_cast<int>(e))[0]));
    const std::vector<int> steps = stepsFrom(lattice, chain, one);
    const int other = farthest(steps);
    const int length = steps[static_cast<std::size_t>(other)];
    const bool counts =
        static_cast<float>(length) * raster.size >= kShortestTear && isLine(lattice, chain, steps, length);
    for (std::size_t corner = 0; corner < steps.size(); ++corner) {
      if (steps[corner] < 0) continue;
      done[corner] = true;
      if (!counts) continue;
      raster.split[corner] = 1;
      for (int edge : lattice.edgesAt(static_cast<int>(corner)))
        if (edge >= 0 && chain[static_cast<std::size_t>(edge)]) lattice.torn[static_cast<std::size_t>(edge)] = true;
    }
    if (!counts) continue;
    const std::vector<bool> beside = cornersBeside(lattice, steps);
    for (int end : {one, other})
      if (!lattice.atRim(end)) tearOn(lattice, end, beside);
  }
}

int spreadRegions(Lattice& lattice, std::vector<int>& sizes) {
  RootRaster& raster = lattice.raster;
  for (RootCell& cell : raster.cells) cell.region = -1;
  sizes.clear();
  for (std::size_t start = 0; start < raster.cells.size(); ++start) {
    if (raster.cells[start].path.empty() || raster.cells[start].region >= 0) continue;
    const int region = static_cast<int>(sizes.size());
    std::vector<int> area{static_cast<int>(start)};
    raster.cells[start].region = region;
    const auto enter = [&](int edge, int cell) {
      if (lattice.apart[static_cast<std::size_t>(edge)] < 0 || lattice.torn[static_cast<std::size_t>(edge)]) return;
      RootCell& next = raster.cells[static_cast<std::size_t>(cell)];
      if (next.region >= 0) return;
      next.region = region;
      area.push_back(cell);
    };
    for (std::size_t k = 0; k < area.size(); ++k) {
      const int cell = area[k], x = cell % raster.columns, y = cell / raster.columns;
      if (x + 1 < raster.columns) enter(2 * cell, cell + 1);
      if (x > 0) enter(2 * (cell - 1), cell - 1);
      if (y + 1 < raster.rows) enter(2 * cell + 1, cell + raster.columns);
      if (y > 0) enter(2 * (cell - raster.columns) + 1, cell - raster.columns);
    }
    sizes.push_back(static_cast<int>(area.size()));
  }
  return static_cast<int>(sizes.size());
}

// The neighbour that the smallest region differs least from, or -1.
int likestNeighbour(const Lattice& lattice, int region) {
  const RootRaster& raster = lattice.raster;
  std::map<int, std::pair<double, int>> borders;
  for (std::size_t e = 0; e < lattice.apart.size(); ++e) {
    if (lattice.apart[e] < 0) continue;
    const std::size_t cell = e / 2, other = cell + (e % 2 == 0 ? 1 : static_cast<std::size_t>(raster.columns));
    const int a = raster.cells[cell].region, b = raster.cells[other].region;
    if (a == b || (a != region && b != region)) continue;
    auto& border = borders[a == region ? b : a];
    border.first += lattice.apart[e];
    ++border.second;
  }
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [other, border] : borders) {
    if (border.first / border.second >= least) continue;
    least = border.first / border.second;
    best = other;
  }
  return best;
}

void joinSmallRegions(Lattice& lattice) {
  RootRaster& raster = lattice.raster;
  std::vector<int> sizes;
  spreadRegions(lattice, sizes);
  int all = 0;
  for (int size : sizes) all += size;
  std::vector<bool> alone(sizes.size(), false);
  while (true) {
    int smallest = -1;
    for (int r = 0; r < static_cast<int>(sizes.size()); ++r) {
      if (sizes[static_cast<std::size_t>(r)] == 0 || alone[static_cast<std::size_t>(r)]) continue;
      if (smallest < 0 || sizes[static_cast<std::size_t>(r)] < sizes[static_cast<std::size_t>(smallest)]) smallest = r;
    }
    if (smallest < 0 || sizes[static_cast<std::size_t>(smallest)] >= kSmallestRegion * all) break;
    const int into = likestNeighbour(lattice, smallest);
    if (into < 0) {
      alone[static_cast<std::size_t>(smallest)] = true;
      continue;
    }
    for (RootCell& cell : raster.cells)
      if (cell.region == smallest) cell.region = into;
    sizes[static_cast<std::size_t>(into)] += sizes[static_cast<std::size_t>(smallest)];
    sizes[static_cast<std::size_t>(smallest)] = 0;
  }
  std::vector<int> number(sizes.size(), -1);
  raster.regions = 0;
  for (std::size_t r = 0; r < sizes.size(); ++r)
    if (sizes[r] > 0) number[r] = raster.regions++;
  for (RootCell& cell : raster.cells)
    if (cell.region >= 0) cell.region = number[static_cast<std::size_t>(cell.region)];
}

}  // namespace

void tearApart(double tears, RootRaster& raster) {
  Lattice lattice = measure(raster);
  tearChains(tears, lattice);
  joinSmallRegions(lattice);
}

}  // namespace app
