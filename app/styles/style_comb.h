// How a style falls: the coat of hair between an inner guide surface (the skin, then the underside of the hair) and an
// outer one, both followed from the parting over the hairline down to where the hair is cut.
#pragma once

#include <algorithm>
#include <cmath>

#include "app/figure/smoothstep.h"
#include "app/styles/hair_styles.h"
#include "app/styles/style_roots.h"

namespace app {

// How high hair lies over the inner guide after a way (m) from its root: it leaves the scalp at a flat angle, and lies
// on all that is rooted further down its sheet, which is more the further it has come.
struct Rise {
  double lift = 0, reach = 1;  // m: height gained at the root, and the way over which it is gained
  double slope = 0;            // m of height per m of way between the parting and the hairline
  double hairline = 0;         // m of way from the parting

  // m; rank: 0 rooted at the hairline, 1 at the parting.
  double height(double rank, double way) const {
    return lift * (1 - std::exp(-std::max(0.0, way) / reach)) + slope * std::clamp(way, 0.0, rank * hairline);
  }
};

// Rows run down every sheet: `scalp_rows` of them on the skin, the rest below the hairline. Rows are real numbers where
// a place between two rows is meant.
struct Coat {
  int sheets = 0, rows = 0, scalp_rows = 0;
  std::vector<Vec3> inner, outer;  // m, sheets x rows
  std::vector<Vec3> up;            // unit, sheets x rows: off the inner guide towards the outer one
  std::vector<Vec3> swept;         // m, sheets x rows: how far the inner guide lies before the roots' flow lines
  std::vector<double> travelled;   // m, sheets x rows: arc length of the inner guide from the parting
  std::vector<double> cut_row;     // per sheet: the row where the hair is cut
  int front_sheets = 0;            // of each half, that fall in front of the shoulders; the others fall behind
  bool fringe = false;             // the parting ends behind it as at the crown
  std::vector<Rise> rise;          // per sheet
  std::vector<double> slant;       // m, per sheet: what the hairline's columns lead the parting's by where hair hangs

  // Whether a sheet goes on straight where the parting ends.
  bool endsParting(int sheet) const {
    return 2 * sheet == sheets - 1 || (fringe && (sheet == 0 || sheet == sheets - 1));
  }
  bool inFront(int sheet) const { return std::min(sheet, sheets - 1 - sheet) < front_sheets; }
  std::size_t index(int sheet, int row) const { return static_cast<std::size_t>(sheet) * rows + row; }
};

Coat combCoat(Style style, const Scalp& scalp, const BodyDistance& body, const FlowLines& lines);

// Unit gradient of the body's distance by central differences; +y where it vanishes.
Vec3 bodyNormal(const BodyDistance& body, const Vec3& p);

}  // namespace app
