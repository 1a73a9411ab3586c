#include "app/styles/style_weave.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace app {
namespace {

constexpr double kTurn = 0.01;        // m of way over which a column takes up the step
constexpr double kSweptAfter = 0.05;  // m of way from its root over which a column takes up the sweep over the forehead

// A column to be: the sheet it runs in and its rank, 0 at the hairline to 1 at the parting.
struct Plait {
  int sheet;
  double rank;
  int layers;
};

template <class T>
T sampleRow(const Coat& coat, const std::vector<T>& values, int sheet, double row) {
  const double place = std::clamp(row, 0.0, coat.rows - 1.0);
  const int r = std::min(static_cast<int>(place), coat.rows - 2);
  const double t = place - r;
  return T((1 - t) * values[coat.index(sheet, r)] + t * values[coat.index(sheet, r + 1)]);
}

// The row at which a sheet's inner guide has gone a way (m) from the parting.
double rowAt(const Coat& coat, int sheet, double way) {
  const auto first = coat.travelled.begin() + coat.index(sheet, 0), last = first + coat.rows;
  const auto after = std::upper_bound(first + 1, last - 1, way);
  const double span = *after - *(after - 1);
  return (after - 1 - first) + std::clamp((way - *(after - 1)) / std::max(span, 1e-12), 0.0, 1.0);
}

// Where layers are cut along the outermost columns: closer over the head, where the hair bends, than where it hangs.
double gradedPlace(double x, double grading) {
  return x * (1 - grading + grading * x);
}

// m of the inner guide that a column has come to at a layer. The outermost column of a sheet is cut by the grading; an
// inner one creeps along the scalp until that has come up to it, and then keeps in step, a little ahead. Layers turn
// from lying along the scalp to square to the hair where the outermost column passes: on a round head every edge dips
// below the scalp's tangent, and prisms of long edges are positive only if their columns climb. The slant that is left
// makes room between columns in a thin coat, and the ends are the thinner for it.
double wayAt(const Coat& coat, const Weave& plan, const Plait& plait, int layer) {
  const auto placeOf = [&](int l) { return gradedPlace(l / (plan.outer_layers - 1.0), plan.grading); };
  const int sheet = plait.sheet;
  const double end = sampleRow(coat, coat.travelled, sheet, coat.cut_row[sheet]) - coat.slant[sheet];
  const double root = (1 - plait.rank) * coat.rise[sheet].hairline, outermost = end * placeOf(layer);
  if (layer == 0) return root;
  const double creeping = root + plan.creep * layer, keeping_step = outermost + (1 - plait.rank) * coat.slant[sheet];
  return 0.5 * (creeping + keeping_step + std::hypot(creeping - keeping_step, kTurn));
}

void layColumn(const Coat& coat, const Weave& plan, const Plait& plait, Woven& woven) {
  const int sheet = plait.sheet;
  const Rise& rise = coat.rise[sheet];
  const double root = (1 - plait.rank) * rise.hairline;
  for (int l = 0; l < plait.layers; ++l) {
    const double way = wayAt(coat, plan, plait, l), row = rowAt(coat, sheet, way), full = rise.height(1, way);
    const double late = 1 - smoothstep(0.0, kSweptAfter, way - root);
    const Vec3 inner = sampleRow(coat, coat.inner, sheet, row), up = sampleRow(coat, coat.up, sheet, row).normalized();
    const double thickness = (sampleRow(coat, coat.outer, sheet, row) - inner).norm();
    const double height = full > 0 ? rise.height(plait.rank, way - root) / full * thickness : 0.0;
    woven.shape.positions.push_back(inner - late * sampleRow(coat, coat.swept, sheet, row) + height * up);
    woven.up.push_back(up);
  }
  woven.shape.column_first.push_back(static_cast<int>(woven.shape.positions.size()));
}

sim::RootFace quad(int a, int b, int c, int d) {
  return {4, {a, b, c, d}};
}
sim::RootFace triangle(int a, int b, int c) {
  return {3, {a, b, c, -1}};
}

// Joins two neighbouring sheets from the hairline up: quads while the ranks keep step, a triangle where one sheet has
// one more.
void joinSheets(const std::vector<Plait>& plaits, const Coat& coat, std::array<int, 2> left, std::array<int, 2> right,
                std::vector<sim::RootFace>& faces) {
  const bool left_goes_on = coat.endsParting(plaits[left[0]].sheet),
             right_goes_on = coat.endsParting(plaits[right[0]].sheet);
  int i = left[0], j = right[0];
  while (i + 1 < left[1] || j + 1 < right[1]) {
    const bool left_done = i + 1 == left[1], right_done = j + 1 == right[1];
    if (!left_done && !right_done) {
      const int left_over = left[1] - i, right_over = right[1] - j;
      const double gap = plaits[i + 1].rank - plaits[j + 1].rank;
      // The odd one goes where the two sheets' ranks have drifted apart by a third of a step.
      const double step = 1.0 / std::max(left[1] - left[0], right[1] - right[0]);
      if (left_over == right_over || std::abs(gap) < step / 3) {
        // Where the parting ends, a sheet and the bank meet in a straight angle, which two triangles halve.
        const bool top = i + 2 == left[1] && j + 2 == right[1];
        if (top && left_goes_on) {
          faces.push_back(triangle(i, j, i + 1));
          faces.push_back(triangle(j, j + 1, i + 1));
        } else if (top && right_goes_on) {
          faces.push_back(triangle(i, j, j + 1));
          faces.push_back(triangle(i, j + 1, i + 1));
        } else {
          faces.push_back(quad(i, j, j + 1, i + 1));
        }
        ++i, ++j;
        continue;
      }
      if (gap < 0) {
        faces.push_back(triangle(i, j, i + 1));
        ++i;
      } else {
        faces.push_back(triangle(i, j, j + 1));
        ++j;
      }
    } else if (right_done) {
      faces.push_back(triangle(i, j, i + 1));
      ++i;
    } else {
      faces.push_back(triangle(i, j, j + 1));
      ++j;
    }
  }
}

// A bundle ends with its shortest column, and a column with its longest bundle: no vertex is left hanging.
void trimLayers(const std::vector<sim::RootFace>& faces, std::vector<Plait>& plaits) {
  std::vector<int> used(plaits.size(), 0);
  for (const sim::RootFace& face : faces) {
    int layers = plaits[face.columns[0]].layers;
    for (int k = 1; k < face.corner_count; ++k) layers = std::min(layers, plaits[face.columns[k]].layers);
    for (int k = 0; k < face.corner_count; ++k) used[face.columns[k]] = std::max(used[face.columns[k]], layers);
  }
  for (std::size_t c = 0; c < plaits.size(); ++c) plaits[c].layers = used[c];
}

}  // namespace

constexpr double kRefinedCreep = 0.007;

Weave weaveOf(Style style, Resolution resolution) {
  const auto even = [](int intervals) {
    std::vector<double> q(intervals + 1);
    for (int i = 0; i <= intervals; ++i) q[i] = static_cast<double>(i) / intervals;
    return q;
  };
  const int level = static_cast<int>(resolution);
  // The finest plans are refined once more by makeStyle, which about doubles sheets and layers.
  switch (style) {
    case Style::kShort:
    case Style::kShaved:
      return std::array<Weave, 5>{Weave{even(5), 3, 5, 5, 5, 0.6}, Weave{even(7), 4, 7, 6, 7, 0.5},
                                  Weave{even(11), 4, 10, 7, 8, 0.4}, Weave{even(11), 4, 9, 11, 12, 0.3, kRefinedCreep},
                                  Weave{even(3), 2, 3, 5, 5, 0.6}}[level];
    case Style::kShoulder:
      return std::array<Weave, 5>{Weave{even(5), 3, 5, 8, 8, 0.5}, Weave{even(8), 3, 6, 10, 12, 0.4},
                                  Weave{even(11), 4, 9, 14, 15, 0.3}, Weave{even(11), 4, 9, 15, 16, 0.3, kRefinedCreep},
                                  Weave{even(3), 2, 3, 7, 7, 0.5}}[level];
    case Style::kBob:
      return std::array<Weave, 5>{Weave{even(6), 4, 5, 7, 7, 0.5}, Weave{even(9), 5, 6, 9, 10, 0.4},
                                  Weave{even(11), 6, 9, 12, 14, 0.3}, Weave{even(11), 6, 9, 14, 15, 0.3, kRefinedCreep},
                                  Weave{{0, 0.18, 0.36, 0.68, 1}, 3, 3, 6, 6, 0.5}}[level];
    case Style::kPixie:
      return std::array<Weave, 5>{Weave{even(6), 4, 5, 5, 5, 0.6}, Weave{even(9), 5, 7, 6, 7, 0.5},
                                  Weave{even(11), 6, 10, 7, 8, 0.4}, Weave{even(11), 6, 9, 11, 12, 0.3, kRefinedCreep},
                                  Weave{{0, 0.18, 0.36, 0.68, 1}, 3, 3, 5, 5, 0.6}}[level];
    case Style::kLong:
      break;
  }
  // Sheets stand close on both sides of where the hair divides.
  const std::vector<double> fine{0, 0.08, 0.16, 0.24, 0.325, 0.35, 0.47, 0.6, 0.73, 0.86, 1};
  return std::array<Weave, 5>{Weave{{0, 0.17, 0.325, 0.35, 0.7, 1}, 3, 6, 8, 8, 0.7},
                              Weave{{0, 0.17, 0.325, 0.35, 0.57, 0.78, 1}, 4, 6, 13, 14, 0.5},
                              Weave{fine, 4, 10, 15, 16, 0.4}, Weave{fine, 4, 9, 19, 20, 0.4, kRefinedCreep},
                              Weave{{0, 0.325, 0.35, 0.68, 1}, 2, 4, 6, 6, 0.4}}[level];
}

Woven weave(const Coat& coat, const Weave& plan) {
  const int half = static_cast<int>(plan.backness.size()) - 1;
  // Of a fringe the two halves share the middle sheet over the forehead as they do the one at the nape.
  const int sheet_count = coat.fringe ? 2 * half : 2 * half + 1;
  std::vector<Plait> plaits;
  std::vector<std::array<int, 2>> sheets;  // first column and the one after the last
  for (int i = 0; i < sheet_count; ++i) {
    const double q = plan.backness[i <= half ? i : 2 * half - i];
    const int middle = coat.sheets / 2;
    const int sheet = static_cast<int>(std::lround(i <= half ? q * middle : (2 - q) * middle));
    const int ranks = static_cast<int>(
        std::lround(plan.front_ranks + (plan.back_ranks - plan.front_ranks) * smoothstep(0.0, 0.8, q)));
    const int first = static_cast<int>(plaits.size());
    for (int r = 0; r < ranks; ++r) {
      const double rank = static_cast<double>(r) / (ranks - 1);
      const double fewer =
          (plan.outer_layers - plan.inner_layers) * std::max(0.0, 1 - static_cast<double>(r) / (ranks - 1) / 0.5);
      plaits.push_back({sheet, rank, plan.outer_layers - static_cast<int>(std::lround(fewer))});
    }
    sheets.push_back({first, first + ranks});
  }
  Woven woven;
  for (int i = 0; i < 2 * half; ++i) {
    const int next = (i + 1) % sheet_count;
    // Hair before and behind the shoulders has nothing between.
    if (coat.front_sheets > 0 &&
        coat.inFront(plaits[sheets[i][0]].sheet) != coat.inFront(plaits[sheets[next][0]].sheet))
      continue;
    // The right half is joined as the left one's mirror image.
    joinSheets(plaits, coat, sheets[i], sheets[next], woven.shape.root_faces);
  }
  trimLayers(woven.shape.root_faces, plaits);
  for (const Plait& plait : plaits) layColumn(coat, plan, plait, woven);
  return woven;
}

}  // namespace app
