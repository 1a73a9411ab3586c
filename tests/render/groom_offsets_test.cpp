// Where strands of a groom grow, beside the hair mesh that is simulated.
#include "render/strands/groom_offsets.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/synthetic_hair.h"

namespace groom_offsets_test {

using Eigen::Vector3f;
using render::GroomOffsets;

constexpr float kOffset = 0.004f;  // m

// Every vertex but the roots has an offset of its own.
struct GroomedHair {
  synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 10);
  std::vector<float> rest{input.positions.begin(), input.positions.end()}, offsets;

  GroomedHair() {
    offsets.assign(rest.size(), 0);
    for (const render::HairFace& face : input.faces) {
      for (const int first : face.first_vertex) {
        for (int l = 1; first >= 0 && l < face.layers; ++l) {
          for (int k = 0; k < 3; ++k)
            offsets[static_cast<std::size_t>(3 * (first + l) + k)] =
                kOffset * std::sin(static_cast<float>(7 * (first + l) + 3 * k));
        }
      }
    }
  }
};

Vector3f at(const std::vector<float>& values, std::size_t vertex) {
  return Eigen::Map<const Vector3f>(&values[3 * vertex]);
}

TEST(GroomOffsets, LeadAtRestToWhereTheGroomIsAndTurnWithTheHead) {
  const GroomedHair groomed;
  const GroomOffsets offsets(groomed.input.faces, groomed.rest, groomed.offsets);
  ASSERT_FALSE(offsets.empty());
  const Eigen::Affine3f turned =
      Eigen::Translation3f(0.3f, 1.2f, -0.4f) * Eigen::AngleAxisf(1.9f, Vector3f(0.4f, 1, -0.3f).normalized());
  std::vector<float> moved = groomed.rest, drawn, drawn_moved;
  for (std::size_t v = 0; v < moved.size() / 3; ++v)
    Eigen::Map<Vector3f>(moved.data() + 3 * v) = turned * at(groomed.rest, v);
  offsets.add(groomed.rest, drawn);
  offsets.add(moved, drawn_moved);
  float most = 0;
  for (std::size_t v = 0; v < moved.size() / 3; ++v) {
    const Vector3f wanted = at(groomed.rest, v) + at(groomed.offsets, v);
    EXPECT_LT((at(drawn, v) - wanted).norm(), 1e-6f) << v;
    EXPECT_LT((at(drawn_moved, v) - turned * wanted).norm(), 3e-6f) << v;
    most = std::max(most, at(groomed.offsets, v).norm());
  }
  EXPECT_GT(most, 0.5f * kOffset);
}

// A strand that swings a quarter turn about an axis takes its offsets with it, at their length.
TEST(GroomOffsets, KeepTheirLengthWhereHairBends) {
  const GroomedHair groomed;
  const GroomOffsets offsets(groomed.input.faces, groomed.rest, groomed.offsets);
  std::vector<float> bent = groomed.rest, drawn;
  for (std::size_t v = 0; v < bent.size() / 3; ++v) {
    const Vector3f p = at(groomed.rest, v);
    Eigen::Map<Vector3f>(bent.data() + 3 * v) = Eigen::AngleAxisf(12 * p.y(), Vector3f::UnitX()) * p;
  }
  offsets.add(bent, drawn);
  float turned = 0;
  for (std::size_t v = 0; v < bent.size() / 3; ++v) {
    const Vector3f now = at(drawn, v) - at(bent, v), then = at(groomed.offsets, v);
    EXPECT_NEAR(now.norm(), then.norm(), 1e-6f) << v;
    turned = std::max(turned, (now - then).norm());
  }
  EXPECT_GT(turned, 0.2f * kOffset) << "offsets that stayed as they were would pass as well";
}

TEST(GroomOffsets, OfNoughtOrAnotherNumberAreNone) {
  const GroomedHair groomed;
  EXPECT_TRUE(GroomOffsets().empty());
  EXPECT_TRUE(GroomOffsets(groomed.input.faces, groomed.rest, {}).empty());
  EXPECT_TRUE(GroomOffsets(groomed.input.faces, groomed.rest, std::vector<float>(groomed.rest.size(), 0)).empty());
  EXPECT_TRUE(GroomOffsets(groomed.input.faces, groomed.rest, std::span(groomed.offsets).first(3)).empty());
  std::vector<float> drawn;
  GroomOffsets().add(groomed.rest, drawn);
  EXPECT_EQ(drawn, groomed.rest);
}

}  // namespace groom_offsets_test
