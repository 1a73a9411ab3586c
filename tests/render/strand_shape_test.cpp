// What makes a head of hair out of a hair mesh: groups, strays, hairline, curls; stable in motion.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "app/styles/hair_styles.h"
#include "render/strands/strand_growth.h"
#include "sim/mesh/hair_mesh.h"
#include "tests/analytic_head.h"
#include "tests/synthetic_hair.h"

namespace strand_shape_test {

using Eigen::Vector3f;
using render::CurvePoint;
using render::StrandGrowth;

struct StyledHair {
  std::vector<render::HairFace> faces;
  std::vector<float> positions;

  explicit StyledHair(app::Style style) {
    const sim::HairMeshShape shape =
        app::makeStyle(style, app::Resolution::kMedium, tests::analyticScalp(), tests::bodyDistance);
    for (const sim::RootFace& root : shape.root_faces) {
      render::HairFace& face = faces.emplace_back();
      for (int k = 0; k < root.corner_count; ++k) face.first_vertex[k] = shape.column_first[root.columns[k]];
      face.layers = shape.bundleLayers(root);
      face.area = 1e-4f;
    }
    for (const sim::Vec3& p : shape.positions)
      for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
  }

  StrandGrowth growth(const render::HairLook& look, int strands = 4000) const {
    return {faces, positions, strands, 3, look};
  }
};

std::vector<CurvePoint> evenly(const StrandGrowth& growth, int number, int count) {
  std::vector<CurvePoint> points(static_cast<std::size_t>(count));
  growth.growEven(growth.strand(number), points);
  return points;
}

TEST(StrandShape, CurlsAreHelicesOfTheirPitch) {
  const StyledHair hair(app::Style::kLong);
  render::HairLook look = synthetic::plainLook();
  const StrandGrowth straight = hair.growth(look, 200);
  look.curl_radius = 0.006f;
  look.curl_pitch = 0.04f;
  const StrandGrowth curled = hair.growth(look, 200);
  for (int number = 0; number < curled.strandCount(); ++number) {
    const std::vector<CurvePoint> guide = evenly(straight, number, 2001), curl = evenly(curled, number, 2001);
    double turned = 0;
    for (std::size_t i = 600; i + 1 < guide.size(); ++i) {
      const Vector3f from = curl[i].position - guide[i].position, to = curl[i + 1].position - guide[i + 1].position;
      ASSERT_NEAR(from.norm(), 0.006f, 0.003f) << "m";
      ASSERT_LT(std::abs(from.normalized().dot(guide[i].tangent)), 0.05f);
      turned += std::atan2(from.cross(to).dot(guide[i].tangent), from.dot(to));
    }
    const double turns = std::abs(turned) / (2 * std::numbers::pi);
    const render::Strand strand = curled.strand(number);
    const float begin = 0.3f * strand.end;
    const double metres = strand.metres - begin * (strand.way.x() + strand.way.y() * begin);
    EXPECT_NEAR(turns, metres / 0.04, 0.35 * metres / 0.04);
    // Enough points that a turn is round.
    EXPECT_GE(strand.segments * strand.end / (strand.metres / 0.04), 10);
  }
}

TEST(StrandShape, TheHairlineIsThinAndThePartingIsNot) {
  const StyledHair hair(app::Style::kShoulder);
  const render::HairLook look;
  const StrandGrowth growth = hair.growth(look, 20000);
  const auto& columns = growth.layout().columns;
  int at_hairline = 0, parting = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) at_hairline += columns[c].edge < 1e-4f;
  // The parting's columns are the highest: hair goes on at its other side.
  for (const render::HairColumn& column : columns) parting += column.rest.y() > 0.03f && column.edge > 0.02f;
  EXPECT_GT(at_hairline, 15);
  EXPECT_LT(at_hairline, static_cast<int>(columns.size()) / 3);
  EXPECT_GT(parting, 5);
  int near = 0, near_left = 0, near_fine = 0, inside_left = 0;
  for (int number = 0; number < growth.strandCount(); ++number) {
    const render::Strand strand = growth.strand(number);
    near += strand.rim > 0.5f;
    near_left += strand.rim > 0.5f && strand.gain == 0;
    near_fine += strand.rim > 0.5f && strand.fine > 0;
    inside_left += strand.rim == 0 && (strand.gain == 0 || strand.fine > 0);
    if (strand.fine > 0) {
      EXPECT_LT(strand.metres, 0.04f);
    }
  }
  EXPECT_GT(near, 300);
  EXPECT_GT(near_left, near / 4);
  EXPECT_LT(near_left, 3 * near / 4);
  EXPECT_GT(near_fine, near / 4);
  EXPECT_EQ(inside_left, 0);
}

TEST(StrandShape, StrayHairsStandOffTheHair) {
  const StyledHair hair(app::Style::kShoulder);
  render::HairLook look = synthetic::plainLook();
  look.flyaways = 1;
  look.flyaway_lift = 0;
  const StrandGrowth flat = hair.growth(look, 500);
  look.flyaway_lift = 0.01f;
  const StrandGrowth lifted = hair.growth(look, 500);
  const Vector3f center = render::middleOfHead(flat.layout(), hair.positions);
  double farther = 0;
  for (int number = 0; number < 500; ++number) {
    const Vector3f low = evenly(flat, number, 9)[4].position, high = evenly(lifted, number, 9)[4].position;
    EXPECT_LT((high - low).norm(), 2 * look.flyaway_lift);
    farther += ((high - center).norm() - (low - center).norm()) / 500;
  }
  EXPECT_GT(farther, 0.3 * look.flyaway_lift);
}

TEST(StrandShape, GroupsDrawTheirHairsTogether) {
  const StyledHair hair(app::Style::kLong);
  // Median distance (m) of a strand's point from that of the strand of the same group before it.
  const auto spread = [&](const render::HairLook& look, std::uint32_t render::Strand::*group) {
    const StrandGrowth growth = hair.growth(look, 4000);
    std::map<std::uint32_t, Vector3f> last;
    std::vector<float> distances;
    for (int number = 0; number < growth.strandCount(); ++number) {
      const Vector3f p = evenly(growth, number, 9)[6].position;
      const auto [place, added] = last.try_emplace(growth.strand(number).*group, p);
      if (!added) distances.push_back((place->second - p).norm());
      place->second = p;
    }
    std::nth_element(distances.begin(), distances.begin() + static_cast<long>(distances.size() / 2), distances.end());
    return distances[distances.size() / 2];
  };
  for (const auto& [pull, group] : {std::pair{&render::HairLook::lock, &render::Strand::lock_key},
                                    std::pair{&render::HairLook::clump, &render::Strand::clump_key}}) {
    render::HairLook look = synthetic::plainLook();
    const float loose = spread(look, group);
    look.*pull = 1;
    EXPECT_LT(spread(look, group), 0.6f * loose);
  }
}

// A hair keeps its looks from frame to frame: what moves rigidly keeps every hair's shape.
TEST(StrandShape, MovesRigidlyWithTheHead) {
  const StyledHair hair(app::Style::kLong);
  render::HairLook look;
  look.curl_radius = look.wave_height = 0.004f;
  StrandGrowth growth = hair.growth(look, 1000);
  const Eigen::Isometry3f motion =
      Eigen::Translation3f(0.3f, 1.2f, -0.4f) * Eigen::AngleAxisf(0.8f, Vector3f(0.2f, 0.9f, -0.3f).normalized());
  std::vector<std::vector<CurvePoint>> before;
  for (int number = 0; number < 1000; ++number) before.push_back(evenly(growth, number, 17));
  std::vector<float> moved;
  for (std::size_t i = 0; i < hair.positions.size(); i += 3) {
    const Vector3f p = motion * Vector3f(hair.positions[i], hair.positions[i + 1], hair.positions[i + 2]);
    moved.insert(moved.end(), {p.x(), p.y(), p.z()});
  }
  ASSERT_TRUE(growth.setPositions(moved));
  for (int number = 0; number < 1000; ++number) {
    const std::vector<CurvePoint> after = evenly(growth, number, 17);
    for (std::size_t i = 0; i < after.size(); ++i)
      ASSERT_LT((motion * before[static_cast<std::size_t>(number)][i].position - after[i].position).norm(), 2e-5f);
  }
}

}  // namespace strand_shape_test
