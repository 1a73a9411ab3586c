// Painted shares of the look: every path draws them alike, the CPU grows the same strands, each acts where it is
// painted and nowhere else.
#include "render/strands/look_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/renderer.h"
#include "render/strands/strand_growth.h"
#include "tests/draw_skips.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"
#include "tests/strand_capture.h"
#include "tests/synthetic_hair.h"

namespace look_share_test {

using render::LookShare;
using render::StrandPath;

// Hair that is painted by halves, left (x < 0) and right, and along its strands.
struct Painted {
  synthetic::Hair hair = synthetic::makeHair();
  synthetic::Body body = synthetic::makeBody();
  std::vector<LookShare> roots, along;

  Painted(const LookShare& left, const std::vector<LookShare>& from_root) : along(from_root) {
    for (std::size_t v = 0; v < hair.positions.size(); v += 3)
      roots.push_back(hair.positions[v] < 0 ? left : LookShare{});
  }
  render::HairInput input(int strands) const {
    render::HairInput input = synthetic::hairInput(hair, strands);
    input.rest = hair.positions;
    input.shares = {roots, along};
    input.look.curl_radius = 0.004f;
    input.look.frizz = 0.001f;
    return input;
  }
  render::StrandGrowth growth(int strands) const {
    const render::HairInput of = input(strands);
    return {of.faces, of.rest, of.strands, of.segments_per_layer, of.look, of.shares};
  }
};

const LookShare kLeft{0.4f, 0.2f, 0.1f, 0.5f, {1, 0.5f, 0.2f}, 0.3f};
const std::vector<LookShare> kAlong{{1.5f, 1, 0.5f, 1, {1, 1, 1}}, {0.7f, 0.4f, 1.6f, 0.6f, {0.3f, 0.8f, 1}}, {}};

class LookShares : public gl_fixture::GlTest {};

TEST_F(LookShares, EveryPathDrawsThemAlike) {
  const Painted painted(kLeft, kAlong);
  const std::vector<render::HairInput> hairs{painted.input(1500)}, plain{[&] {
    render::HairInput bare = painted.input(1500);
    bare.shares = {};
    return bare;
  }()};
  const std::vector<render::BodyInput> bodies{synthetic::bodyInput(painted.body)};
  render::Renderer renderer(gl_fixture::kShaderDir);
  const auto draw = [&](const std::vector<render::HairInput>& of, StrandPath path) {
    render::FrameInput frame = synthetic::frameInput(of, bodies, 320, 180);
    frame.view.strand_path = path;
    return draw_skips::draw(renderer, frame);
  };
  const app::Image stages = draw(hairs, StrandPath::kGeometry);
  for (const StrandPath path : {StrandPath::kCompute, StrandPath::kSoftware}) {
    const golden::Difference difference = golden::compare(stages, draw(hairs, path), 12);
    EXPECT_LT(difference.outliers, 320 * 180 / 300);
    EXPECT_LT(difference.mean, 0.2);
  }
  render::Renderer fresh(gl_fixture::kShaderDir);
  render::FrameInput frame = synthetic::frameInput(plain, bodies, 320, 180);
  frame.view.strand_path = StrandPath::kGeometry;
  EXPECT_GT(golden::compare(stages, draw_skips::draw(fresh, frame), 12).mean, 1) << "the shares change nothing";
}

TEST_F(LookShares, TheCpuGrowsWhatTheShadersDraw) {
  const Painted painted(kLeft, kAlong);
  const render::HairInput input = painted.input(3000);
  const render::StrandGrowth growth = painted.growth(3000);
  const std::vector<strand_capture::Polyline> drawn = strand_capture::capture(input, gl_fixture::kShaderDir);
  std::vector<render::CurvePoint> points(static_cast<std::size_t>(growth.maxPoints()));
  int other = 0;  // roots on the border of two clumps
  float worst = 0;
  for (int number = 0; number < growth.strandCount(); ++number) {
    const auto count = static_cast<std::size_t>(growth.growDrawn(growth.strand(number), points));
    const strand_capture::Polyline& theirs = drawn[static_cast<std::size_t>(number)];
    ASSERT_EQ(count, theirs.size());
    float apart = 0;
    for (std::size_t i = 0; i < count; ++i) apart = std::max(apart, (points[i].position - theirs[i]).norm());
    if (apart > 1e-4f)
      ++other;
    else
      worst = std::max(worst, apart);
  }
  EXPECT_LT(worst, 1e-5f * 0.3f);
  EXPECT_LE(other, 4);
}

TEST(LookShare, ActsWhereItIsPainted) {
  const Painted painted({0.3f, 1, 0, 1, {0, 1, 1}, 0}, {});
  const render::StrandGrowth growth = painted.growth(2000);
  Painted straight = painted;
  straight.roots.clear();
  render::HairInput input = straight.input(2000);
  const render::StrandGrowth curled(input.faces, input.rest, 2000, input.segments_per_layer, input.look);
  input.look.curl_radius = input.look.frizz = 0;
  const render::StrandGrowth plain(input.faces, input.rest, 2000, input.segments_per_layer, input.look);
  std::vector<render::CurvePoint> points(40), with(40), without(40);
  int left = 0, right = 0;
  for (int number = 0; number < growth.strandCount(); ++number) {
    const render::Strand strand = growth.strand(number);
    growth.growEven(strand, points);
    curled.growEven(curled.strand(number), with);
    plain.growEven(plain.strand(number), without);
    const float x = points[0].position.x();
    const float by_curl = (points[39].position - with[39].position).norm(),
                by_none = (points[39].position - without[39].position).norm();
    if (std::abs(x) < 0.05f) continue;  // across the border shares are mixed
    ++(x < 0 ? left : right);
    EXPECT_NEAR(growth.radius(strand, 0.5f), (x < 0 ? 0.3f : 1.0f) * plain.radius(strand, 0.5f), 1e-8f);
    EXPECT_NEAR(growth.color(strand, 0.5f)[0], x < 0 ? 0 : 1, 1e-5f);
    EXPECT_LT(x < 0 ? by_none : by_curl, 1e-6f);
  }
  EXPECT_GT(left, 100);
  EXPECT_GT(right, 100);
}

TEST(LookShare, CurvesGoFromRootToTipAndTangentsWithThem) {
  const Painted painted({}, kAlong);
  const render::StrandGrowth growth = painted.growth(300);
  LookShare rate;
  EXPECT_FLOAT_EQ(render::shareAlong(growth.layout(), 0).width, 1.5f);
  EXPECT_FLOAT_EQ(render::shareAlong(growth.layout(), 0.25f, &rate).width, 1.1f);
  EXPECT_FLOAT_EQ(rate.width, -1.6f);
  EXPECT_FLOAT_EQ(render::shareAlong(growth.layout(), 1).color[0], 1);
  EXPECT_FLOAT_EQ(growth.layout().curl_share, 1.6f);
  double sum = 0;
  long count = 0;
  std::vector<render::CurvePoint> points(800);
  for (int number = 0; number < growth.strandCount(); ++number) {
    growth.growEven(growth.strand(number), points);
    for (std::size_t i = 1; i + 1 < points.size(); ++i, ++count)
      sum += (points[i + 1].position - points[i - 1].position).normalized().dot(points[i].tangent);
  }
  EXPECT_GT(sum / static_cast<double>(count), 0.997);
}

TEST(LookShare, SharesThatDoNotFitAreLeftOut) {
  const Painted painted(kLeft, {});
  render::HairInput input = painted.input(10);
  input.shares.roots = input.shares.roots.first(5);
  const render::HairLayout layout = render::makeHairLayout(input.faces, input.rest, input.shares);
  EXPECT_TRUE(layout.root_shares.empty());
  EXPECT_EQ(render::shareAlong(layout, 0.5f), LookShare{});
}

}  // namespace look_share_test
