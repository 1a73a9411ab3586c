// Where hair grows and which way it is combed: flow lines on the scalp.
//
// A *sheet* is all the hair that follows one flow line. Sheets are numbered along the hairline from the left temple
// over the left ear, the nape and the right ear to the right temple. Sheet 0 and the last one run along the forehead's
// hairline: hair is swept sideways from the parting, which is why no strand hangs into the face. A flow line starts at
// the parting (the left bank for the left half, the right bank for the right half, the crown for the middle sheet) and
// ends at the hairline.
//
// Of hair with a *fringe* the parting begins behind the forehead, and its flow lines fan out over it: sheet 0 and the
// last one run beside one another from there to the middle of the forehead's hairline.
#pragma once

#include "app/styles/hair_styles.h"

namespace app {

struct FlowLines {
  int sheets = 0;            // odd: the middle one goes from the crown to the nape
  int rows = 0;              // samples a line, evenly spaced by arc length, parting first, hairline last
  std::vector<Vec3> points;  // m, sheets x rows, on the skin

  const Vec3& at(int sheet, int row) const { return points[static_cast<std::size_t>(sheet) * rows + row]; }
  // 0 at the temples (of hair with a fringe at the middle of the forehead), 1 at the nape.
  double backness(int sheet) const;
};

// Unit direction of an azimuth (from +z towards +x) and an elevation above the horizontal, both in degrees.
Vec3 scalpDirection(double azimuth, double elevation);

// The skin's point in a direction from the scalp's centre.
Vec3 skinPoint(const Scalp& scalp, const Vec3& direction);

FlowLines traceFlowLines(const Scalp& scalp, bool fringe);

}  // namespace app
