// How a style falls: the coat of hair between an inner guide surface (the skin, then the underside of the hair) and an
// outer one, both followed from the parting over the hairline down to where the hair is cut.
#pragma once

#include <algorithm>

#include "sim/styles/hair_styles.h"
#include "sim/styles/style_roots.h"

namespace sim {

// Rows run down every sheet: `scalp_rows` of them on the skin, the rest below the hairline. Rows are real numbers where
// a place between two rows is meant.
struct Coat {
  int sheets = 0, rows = 0, scalp_rows = 0;
  std::vector<Vec3> inner, outer;  // m, sheets x rows
  std::vector<double> travelled;   // m, sheets x rows: arc length of the inner guide from the parting
  std::vector<double> cut_row;     // per sheet: the row where the hair is cut
  std::vector<double> short_row;   // per sheet: the row where hair that divides over a shoulder ends
  double divide = -1;              // backness at which the hair divides over the shoulders; negative: it does not

  std::size_t index(int sheet, int row) const { return static_cast<std::size_t>(sheet) * rows + row; }
};

// 0 below a, 1 above b, a cubic between.
inline double smoothstep(double a, double b, double x) {
  const double t = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Coat combCoat(Style style, const Scalp& scalp, const BodyDistance& body, const FlowLines& lines);

// Unit gradient of the body's distance by central differences; +y where it vanishes.
Vec3 bodyNormal(const BodyDistance& body, const Vec3& p);

}  // namespace sim
