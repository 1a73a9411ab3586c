#include "sim/styles/style_weave.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sim {
namespace {

constexpr double kHairlineRise = 0.34;  // share of the coat's thickness that the hairline's own columns rise to
constexpr double kRiseAtHairline = 0.012, kRiseAtParting = 0.048;  // m of travel over which a column leaves the scalp
constexpr double kInStepBelowHairline = 0.04;                      // m

// A column to be: the sheet it runs in and its rank, 0 at the hairline to 1 at the parting.
struct Plait {
  int sheet;
  double rank;
  bool ends_early;  // where the hair divides over a shoulder
  int full_layers;  // from the root to the cut
  int layers;       // of which the column has these
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

// How far a column stands off the inner guide after a way (m) from its root: it leaves the scalp steeply, climbs to its
// own height in the coat and stays there. The share is of the coat's thickness.
double heightShare(double rank, double way, double hairline) {
  const double height = kHairlineRise + (1 - kHairlineRise) * rank;
  const double rise = kRiseAtHairline + (kRiseAtParting * std::min(1.0, hairline / 0.22) - kRiseAtHairline) * rank;
  return height * (1 - std::exp(-way / rise));
}

// Where layers are cut along the outermost columns: closer over the head, where the hair bends, than where it hangs.
double gradedPlace(double x, double grading) {
  return x * (1 - grading + grading * x);
}

// Appends a column's vertices. The outermost column of a sheet is cut by the grading; the inner ones keep in step with
// it, so that layers lie along the scalp at first, have turned square to the hair shortly below the hairline, and stay
// so. Without that the prisms of a coarse mesh would be turned inside out by the curvature of the head.
void layColumn(const Coat& coat, const Weave& plan, const Plait& plait, std::vector<Vec3>& positions) {
  const int sheet = plait.sheet;
  const auto placeOf = [&](int layer) { return gradedPlace(layer / (plan.outer_layers - 1.0), plan.grading); };
  double end = sampleRow(coat, coat.travelled, sheet, coat.cut_row[sheet]);
  if (plait.ends_early)
    end = sampleRow(coat, coat.travelled, sheet, coat.short_row[sheet]) / placeOf(plait.full_layers - 1);
  const double hairline = coat.travelled[coat.index(sheet, coat.scalp_rows - 1)];
  const double root = (1 - plait.rank) * hairline;
  const double in_step = std::min(hairline + kInStepBelowHairline, 1.02 * end);
  for (int l = 0; l < plait.layers; ++l) {
    const double outermost = end * placeOf(l);
    const double behind = std::max(0.0, 1 - outermost / in_step);
    const double way = outermost + root * behind;
    const double row = rowAt(coat, sheet, way), share = heightShare(plait.rank, (way - root), hairline);
    positions.push_back((1 - share) * sampleRow(coat, coat.inner, sheet, row) +
                        share * sampleRow(coat, coat.outer, sheet, row));
  }
}

RootFace quad(int a, int b, int c, int d) {
  return {4, {a, b, c, d}};
}
RootFace triangle(int a, int b, int c) {
  return {3, {a, b, c, -1}};
}

// Joins two neighbouring sheets from the hairline up: quads while the ranks keep step, a triangle where one sheet has
// one more.
void joinSheets(const std::vector<Plait>& plaits, int crown_sheet, std::array<int, 2> left, std::array<int, 2> right,
                std::vector<RootFace>& faces) {
  const bool left_is_crown = plaits[left[0]].sheet == crown_sheet,
             right_is_crown = plaits[right[0]].sheet == crown_sheet;
  int i = left[0], j = right[0];
  while (i + 1 < left[1] || j + 1 < right[1]) {
    const bool left_done = i + 1 == left[1], right_done = j + 1 == right[1];
    if (!left_done && !right_done) {
      const int left_over = left[1] - i, right_over = right[1] - j;
      const double gap = plaits[i + 1].rank - plaits[j + 1].rank;
      // The odd one goes where the two sheets' ranks have drifted apart by a third of a step.
      const double step = 1.0 / std::max(left[1] - left[0], right[1] - right[0]);
      if (left_over == right_over || std::abs(gap) < step / 3) {
        // The crown's column ends the parting: its sheet and the bank meet in a straight angle there, which two
        // triangles halve.
        const bool top = i + 2 == left[1] && j + 2 == right[1];
        if (top && left_is_crown) {
          faces.push_back(triangle(i, j, i + 1));
          faces.push_back(triangle(j, j + 1, i + 1));
        } else if (top && right_is_crown) {
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
void trimLayers(const std::vector<RootFace>& faces, std::vector<Plait>& plaits) {
  std::vector<int> used(plaits.size(), 0);
  for (const RootFace& face : faces) {
    int layers = plaits[face.columns[0]].layers;
    for (int k = 1; k < face.corner_count; ++k) layers = std::min(layers, plaits[face.columns[k]].layers);
    for (int k = 0; k < face.corner_count; ++k) used[face.columns[k]] = std::max(used[face.columns[k]], layers);
  }
  for (std::size_t c = 0; c < plaits.size(); ++c) plaits[c].layers = used[c];
}

}  // namespace

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
      return std::array<Weave, 5>{Weave{even(5), 3, 5, 5, 5, 0, 0.0}, Weave{even(7), 4, 7, 6, 7, 0, 0.0},
                                  Weave{even(11), 4, 10, 7, 8, 0, 0.0}, Weave{even(11), 4, 9, 11, 12, 0, 0.0},
                                  Weave{even(3), 2, 3, 5, 5, 0, 0.0}}[level];
    case Style::kShoulder:
      return std::array<Weave, 5>{Weave{even(5), 3, 5, 8, 8, 0, 0.2}, Weave{even(8), 3, 6, 10, 12, 0, 0.2},
                                  Weave{even(11), 4, 9, 14, 15, 0, 0.2}, Weave{even(11), 4, 9, 15, 16, 0, 0.2},
                                  Weave{even(3), 2, 3, 7, 7, 0, 0.2}}[level];
    case Style::kLong:
      break;
  }
  const std::vector<double> fine{0, 0.1, 0.2, 0.3, 0.35, 0.4, 0.52, 0.64, 0.76, 0.88, 1};
  return std::array<Weave, 5>{Weave{{0, 0.275, 0.35, 0.425, 0.7, 1}, 3, 6, 8, 8, 5, 0.7},
                              Weave{{0, 0.15, 0.3, 0.35, 0.4, 0.6, 0.8, 1}, 4, 6, 12, 13, 9, 0.4},
                              Weave{fine, 4, 10, 15, 16, 10, 0.4}, Weave{fine, 4, 9, 19, 20, 11, 0.4},
                              Weave{{0, 0.25, 0.35, 0.45, 1}, 2, 4, 8, 8, 5, 0.7}}[level];
}

HairMeshShape weave(const Coat& coat, const Weave& plan) {
  const int half = static_cast<int>(plan.backness.size()) - 1, sheet_count = 2 * half + 1;
  std::vector<Plait> plaits;
  std::vector<std::array<int, 2>> sheets;  // first column and the one after the last
  for (int i = 0; i < sheet_count; ++i) {
    const double q = plan.backness[i <= half ? i : 2 * half - i];
    const int middle = coat.sheets / 2;
    const int sheet = static_cast<int>(std::lround(i <= half ? q * middle : (2 - q) * middle));
    const int ranks = static_cast<int>(
        std::lround(plan.front_ranks + (plan.back_ranks - plan.front_ranks) * smoothstep(0.0, 0.8, q)));
    const bool ends_early = coat.divide >= 0 && std::abs(q - coat.divide) < 1e-9;
    const int first = static_cast<int>(plaits.size());
    for (int r = 0; r < ranks; ++r) {
      const double rank = static_cast<double>(r) / (ranks - 1);
      const int full = ends_early ? plan.divided_layers : plan.outer_layers;
      const double fewer = (plan.outer_layers - plan.inner_layers) * std::max(0.0, 1 - rank / 0.5);
      plaits.push_back({sheet, rank, ends_early, full, full - static_cast<int>(std::lround(fewer))});
    }
    sheets.push_back({first, first + ranks});
  }
  HairMeshShape shape;
  for (int i = 0; i + 1 < sheet_count; ++i) {
    // The right half is joined as the left one's mirror image.
    joinSheets(plaits, coat.sheets / 2, sheets[i], sheets[i + 1], shape.root_faces);
  }
  trimLayers(shape.root_faces, plaits);
  for (const Plait& plait : plaits) {
    layColumn(coat, plan, plait, shape.positions);
    shape.column_first.push_back(static_cast<int>(shape.positions.size()));
  }
  return shape;
}

}  // namespace sim
