// The finer half of a haircut: what it adds lies on the curves that the coarse one samples.
#include "app/styles/style_refine.h"

#include <gtest/gtest.h>

#include "tests/analytic_head.h"
#include "tests/test_meshes.h"

namespace style_refine_test {

using sim::Vec3;

// A column's curve, which four points determine.
Vec3 curveAt(double layer) {
  const double t = layer / 8;
  return {0.03 * t * t - 0.02 * t * t * t, -0.2 * t + 0.05 * t * t, 0.01 * t + 0.04 * t * t * t};
}

TEST(RefinedStyle, AddsPointsOfTheSameCurves) {
  test::PatchOptions o;
  o.nx = 3, o.nz = 2, o.layers = 9;
  sim::HairMeshShape coarse = test::patchShape(o);
  std::vector<Vec3> roots;
  for (int c = 0; c < coarse.columnCount(); ++c) {
    roots.push_back(coarse.positions[coarse.column_first[c]]);
    for (int l = 0; l < coarse.columnLength(c); ++l)
      coarse.positions[coarse.column_first[c] + l] = roots[c] + curveAt(l);
  }
  // Nothing points up: the columns between are not lifted as their roots are.
  const app::Woven woven{coarse, std::vector<Vec3>(coarse.positions.size(), Vec3::Zero())};
  const sim::HairMeshShape fine = app::refined(woven, tests::analyticScalp());
  ASSERT_GT(fine.columnCount(), coarse.columnCount());
  int added = 0;
  for (int c = 0; c < fine.columnCount(); ++c) {
    const Vec3* x = &fine.positions[fine.column_first[c]];
    ASSERT_EQ(fine.columnLength(c), 17);
    // Layers of the coarse mesh and, between inner ones, points of the cubic; at both ends a parabola.
    const Vec3 root = c < coarse.columnCount() ? roots[c] : Vec3(x[2] - curveAt(1));
    for (int l = c < coarse.columnCount() ? 0 : 2; l < 17; ++l) {
      const bool end = l == 1 || l == 15;
      const int from = l == 1 ? 0 : 8, inwards = l == 1 ? 1 : -1;
      const Vec3 parabola = (3 * curveAt(from) + 6 * curveAt(from + inwards) - curveAt(from + 2 * inwards)) / 8;
      const Vec3 expected = end ? parabola : curveAt(0.5 * l);
      EXPECT_LT((x[l] - root - expected).norm(), 1e-12) << "column " << c << ", layer " << l;
      added += l % 2;
    }
  }
  EXPECT_GT(added, 100);
}

}  // namespace style_refine_test
