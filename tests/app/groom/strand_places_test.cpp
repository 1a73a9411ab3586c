// Grooms whose strands are individual otherwise from place to place come back so.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/files/errors.h"
#include "app/files/hair_file.h"
#include "app/groom/convert.h"
#include "app/groom/fit/grown_groom.h"
#include "app/groom/fit/strand_samples.h"
#include "tests/groom_kinds.h"

namespace app {
namespace strand_places_test {

using Eigen::Vector3f;

constexpr int kStrands = 1500, kPoints = 129;
constexpr float kPi = std::numbers::pi_v<float>;

// Means over the strands that root left (x > 0) and right; those about the middle are left out.
template <class Measure>
std::array<double, 2> bySides(const Groom& groom, const Measure& measure) {
  std::array<double, 2> sum{}, count{};
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const float x = groom.strand(s)[0].x();
    if (std::abs(x) < 0.02f) continue;
    sum[x > 0 ? 0 : 1] += measure(groom.strand(s));
    count[x > 0 ? 0 : 1] += 1;
  }
  return {sum[0] / count[0], sum[1] / count[1]};
}

// m, root mean square over the further half of a strand of `kPoints`: of what it leaves its running mean by.
double waver(std::span<const Vector3f> strand) {
  constexpr std::size_t kReach = 9;  // points: half a turn of seven
  double square = 0, count = 0;
  for (std::size_t k = kPoints / 2; k + kReach < strand.size(); ++k, ++count) {
    Vector3f mean = Vector3f::Zero();
    for (std::size_t j = k - kReach; j <= k + kReach; ++j) mean += strand[j] / (2.0f * kReach + 1);
    square += (strand[k] - mean).squaredNorm();
  }
  return std::sqrt(square / count);
}

// Swept back; `offset` as bendStrand's, of the left side's strands.
template <class Offset>
Groom bentOnTheLeft(const Offset& offset) {
  const groom_kinds::Head head;
  Groom groom;
  for (int i = 0; i < kStrands; ++i) {
    const Vector3f root = head.surface(groom_kinds::rootDirection(i, kStrands));
    std::vector<Vector3f> line = groom_kinds::sweptBack(head, root, 0.25f, kPoints);
    const auto key = static_cast<std::uint32_t>(i);
    if (root.x() > 0) groom_kinds::bendStrand(line, [&](float t) { return offset(key, t); });
    groom_kinds::add(line, groom);
  }
  return groom;
}

// radius: m.
Eigen::Vector2f helix(std::uint32_t key, float t, float radius, float turns) {
  const float turn = 2 * kPi * (turns * t + groom_kinds::random(key + 77u));
  return radius * groom_kinds::opened(t) * Eigen::Vector2f(std::cos(turn), std::sin(turn));
}

Eigen::Vector2f curl(std::uint32_t key, float t) {
  return helix(key, t, 0.003f, 7);
}

// Five sines of their own each way.
Eigen::Vector2f frizz(std::uint32_t key, float t) {
  Eigen::Vector2f away = Eigen::Vector2f::Zero();
  for (std::uint32_t n = 0; n < 10; ++n) {
    const float turns = 4 + 5 * groom_kinds::random(40 * key + n), phase = groom_kinds::random(40 * key + n + 20);
    away[n % 2] += 0.0007f * groom_kinds::opened(t) * std::sin(2 * kPi * (turns * t + phase));
  }
  return away;
}

Conversion convert(const Groom& groom) {
  ConvertOptions options;
  options.fit.vertices = 800;
  return convertGroom(groom, {}, options, "made");
}

Groom grownAnew(const Conversion& conversion) {
  render::HairLook look;
  takeLook(conversion.look, look);
  return growGroom(conversion.shape, look, kStrands, kPoints, conversion.look.columns);
}

TEST(StrandPlaces, CurlsOfOneSideComeBackThere) {
  const Groom given = bentOnTheLeft(curl);
  const Conversion conversion = convert(given);
  ASSERT_EQ(conversion.look.columns.size(), static_cast<std::size_t>(conversion.shape.columnCount()));
  EXPECT_NEAR(conversion.look.all.curl_radius, 0.003, 0.0006);
  EXPECT_NEAR(conversion.look.all.curl_turns, 7, 0.8);
  const auto [left, right] = bySides(given, waver);
  const auto [left_anew, right_anew] = bySides(grownAnew(conversion), waver);
  EXPECT_NEAR(left_anew / left, 1, 0.3) << conversionReport(conversion);
  EXPECT_LT(right_anew, 0.15 * left);
  EXPECT_LT(right, 0.1 * left);
  EXPECT_NE(conversionReport(conversion).find("% of the scalp)"), std::string::npos);
}

// Curls that make a strand more than half as long again as its way do not shorten that way.
TEST(StrandPlaces, TightCurlsKeepTheirWay) {
  const Groom given = bentOnTheLeft([](std::uint32_t key, float t) { return helix(key, t, 0.005f, 10); });
  const Conversion conversion = convert(given);
  const auto reach = [](std::span<const Vector3f> strand) { return (strand.back() - strand.front()).norm(); };
  const auto [left, right] = bySides(given, reach);
  const auto [left_anew, right_anew] = bySides(grownAnew(conversion), reach);
  ASSERT_GT(bySides(given, lineLength)[0], 1.45 * bySides(given, lineLength)[1]);
  EXPECT_NEAR(left_anew / left, 1, 0.1) << conversionReport(conversion);
  EXPECT_NEAR(right_anew / right, 1, 0.05);
}

TEST(StrandPlaces, FrizzOfOneSideComesBackThere) {
  const Groom given = bentOnTheLeft(frizz);
  const Conversion conversion = convert(given);
  ASSERT_FALSE(conversion.look.columns.empty());
  const auto [left, right] = bySides(given, waver);
  const auto [left_anew, right_anew] = bySides(grownAnew(conversion), waver);
  EXPECT_NEAR(left_anew / left, 1, 0.4) << conversionReport(conversion);
  EXPECT_LT(right_anew, 0.3 * left);
  EXPECT_LT(right, 0.15 * left);
}

TEST(StrandPlaces, LengthsOfEachSideComeBack) {
  const groom_kinds::Head head;
  Groom given;
  for (int i = 0; i < kStrands; ++i) {
    const Vector3f root = head.surface(groom_kinds::rootDirection(i, kStrands));
    groom_kinds::add(groom_kinds::sweptBack(head, root, root.x() > 0 ? 0.09f : 0.25f, kPoints), given);
  }
  const Conversion conversion = convert(given);
  const auto [left, right] = bySides(given, lineLength);
  const auto [left_anew, right_anew] = bySides(grownAnew(conversion), lineLength);
  EXPECT_NEAR(left_anew / left, 1, 0.1) << conversionReport(conversion);
  EXPECT_NEAR(right_anew / right, 1, 0.1);
}

// Strands of the left side are a third as wide as those of the right.
TEST(StrandPlaces, WidthsOfEachSideComeBack) {
  Groom given = bentOnTheLeft(curl);
  for (std::size_t s = 0; s < given.strandCount(); ++s)
    given.widths.insert(given.widths.end(), given.pointCount(s), given.strand(s)[0].x() > 0 ? 2e-5f : 6e-5f);
  const Conversion conversion = convert(given);
  ASSERT_FALSE(conversion.look.columns.empty());
  std::array<double, 2> sum{}, count{};
  for (int c = 0; c < conversion.shape.columnCount(); ++c) {
    const double x =
        conversion.shape.positions[static_cast<std::size_t>(conversion.shape.column_first[static_cast<std::size_t>(c)])]
            .x();
    if (std::abs(x) < 0.02) continue;  // a column at the parting has strands of both
    sum[x > 0 ? 0 : 1] += conversion.look.columns[static_cast<std::size_t>(c)].width;
    count[x > 0 ? 0 : 1] += 1;
  }
  EXPECT_NEAR(sum[0] / count[0], 1.0 / 3, 0.02) << conversionReport(conversion);
  EXPECT_NEAR(sum[1] / count[1], 1, 0.02);
  EXPECT_NE(conversionReport(conversion).find("of different widths (less than half"), std::string::npos);
  std::ranges::fill(given.widths, 4e-5f);
  for (const ColumnShare& column : convert(given).look.columns) EXPECT_EQ(column.width, 1);
}

TEST(StrandPlaces, SharesAreReadBackToTheBitAndOthersRefused) {
  Conversion conversion = convert(bentOnTheLeft(curl));
  std::vector<ColumnShare>& given = conversion.look.columns;
  given[1] = {1.0 / 3, 0, 1};
  given[2].width = 0.7;
  std::vector<ColumnShare> read;
  const std::string text = writeHairMesh(conversion.shape, given);
  readHairMesh(text, "again.obj", false, "", nullptr, &read);
  EXPECT_EQ(read, given);
  EXPECT_EQ(writeHairMesh(conversion.shape).find("#look_share"), std::string::npos);
  for (const auto& [line, fault] : {std::pair("#look_share 0 1.2 0\n", "not from 0 to 1"),
                                    {"#look_share -0.1 1 0\n", "not from 0 to 1"},
                                    {"#look_share 1 1 0 2\n", "not from 0 to 1"},
                                    {"#look_share 1 nan 0\n", "'nan' is not from 0 to 1"},
                                    {"#look_share 1 1\n", "there are 2 look shares"},
                                    {"#look_share 1 1 1 1 1\n", "there are 5 look shares"},
                                    {"#look_share 1 x 0\n", "'x' is not from 0 to 1"}}) {
    try {
      readHairMesh(std::string(text).insert(text.find("#look_share"), line), "wrong.obj");
      FAIL() << line;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
    }
  }
}

}  // namespace strand_places_test
}  // namespace app
