// Laws of the strand curve: what the geometry stage emits, read back by transform feedback, against its definition on
// the CPU.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "render/hair/hair_store.h"
#include "render/light/fiber_scattering.h"
#include "render/strands/hair_layout.h"
#include "render/view_math.h"
#include "shaders/shared.h"
#include "tests/gl_fixture.h"
#include "tests/strand_capture.h"
#include "tests/strand_reference.h"
#include "tests/synthetic_hair.h"

namespace strand_test {

using Eigen::Vector3f;
using strand_capture::Polyline;
using strand_reference::Reference;

float lengthOf(const Polyline& line) {
  float length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

class StrandCapture : public gl_fixture::GlTest {
 protected:
  // Every strand's points, in the order of the strands.
  std::vector<Polyline> capture(const render::HairInput& input) {
    return strand_capture::capture(input, gl_fixture::kShaderDir);
  }
};

TEST_F(StrandCapture, StrandsFollowTheDefinitionOfTheCurve) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 400);
  input.look = synthetic::plainLook();
  const auto strands = capture(input);
  const render::HairLayout layout = render::makeHairLayout(input.faces, input.positions);
  const Reference reference(layout, input.positions);
  const std::vector<int> first = render::dealStrands(layout, input.strands);
  double worst = 0;
  for (std::size_t face = 0; face < layout.faces.size(); ++face) {
    for (int number = first[face]; number < first[face + 1]; ++number) {
      const auto p = Reference::facePoint(static_cast<std::uint32_t>(face),
                                          static_cast<std::uint32_t>(number - first[face]), input.look.seed);
      ASSERT_EQ(strands[number].size(), static_cast<std::size_t>((hair.layers - 1) * input.segments_per_layer + 1));
      for (std::size_t i = 0; i < strands[number].size(); ++i) {
        const double s = static_cast<double>(i) / input.segments_per_layer;
        const auto expected = reference.curve(static_cast<int>(face), p, s);
        worst = std::max(worst, (expected - strands[number][i].cast<double>()).norm());
      }
    }
  }
  EXPECT_LT(worst, 2e-5);  // m: single precision, and a face point rounded to 24 bits
}

TEST_F(StrandCapture, LongStrandsCutOverSeveralInvocationsAreWhole) {
  const synthetic::Hair hair = synthetic::makeHair(18);
  render::HairInput input = synthetic::hairInput(hair, 200);
  input.segments_per_layer = 8;
  input.look = synthetic::plainLook();
  const std::size_t segments = 17 * 8;
  ASSERT_GT(segments, static_cast<std::size_t>(render::shared::kChunkPoints));
  for (const Polyline& strand : capture(input)) {
    ASSERT_EQ(strand.size(), segments + 1);
    const float mean = lengthOf(strand) / static_cast<float>(segments);
    for (std::size_t i = 1; i < strand.size(); ++i) ASSERT_LT((strand[i] - strand[i - 1]).norm(), 4 * mean);
  }
}

TEST_F(StrandCapture, RootsLieOnTheRoundScalpAndNotOnItsFlatFaces) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 2000);
  input.look = synthetic::plainLook();
  const auto strands = capture(input);
  const Vector3f middle(0, synthetic::kHeadHeight, 0);
  float worst = 0, flat_worst = 0;
  for (const Polyline& strand : strands) {
    worst = std::max(worst, std::abs((strand[0] - middle).norm() - synthetic::kHeadRadius));
  }
  for (const render::HairFace& face : hair.faces) {
    Vector3f center = Vector3f::Zero();
    const int corners = face.first_vertex[3] < 0 ? 3 : 4;
    for (int k = 0; k < corners; ++k) {
      for (int axis = 0; axis < 3; ++axis) center[axis] += hair.positions[3 * face.first_vertex[k] + axis] / corners;
    }
    flat_worst = std::max(flat_worst, synthetic::kHeadRadius - (center - middle).norm());
  }
  EXPECT_GT(flat_worst, 0.006f) << "the scalp's faces are too small to tell";
  EXPECT_LT(worst, 0.5f * flat_worst);  // the hairline, with neighbours on one side only, is the worst
}

TEST_F(StrandCapture, LengthVariationShortensByNoMoreThanItsShare) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 1000);
  input.look = synthetic::plainLook();
  const auto full = capture(input);
  input.look.length_variation = 0.25f;
  const auto cut = capture(input);
  int shorter = 0;
  for (std::size_t i = 0; i < full.size(); ++i) {
    const float share = lengthOf(cut[i]) / lengthOf(full[i]);
    // The layers of this hair are evenly spaced to about a tenth, so length and parameter agree to that.
    EXPECT_GE(share, 0.75f - 0.04f);
    EXPECT_LE(share, 1.0001f);
    shorter += share < 0.95f;
  }
  EXPECT_GT(shorter, 300);
}

TEST_F(StrandCapture, BundlesOfDifferentLengthsAreCutAlongOneSmoothLine) {
  synthetic::Hair hair = synthetic::makeHair();
  // Every other quadrilateral of the last ring ends three layers early.
  for (std::size_t face = 30; face < hair.faces.size(); face += 2) hair.faces[face].layers -= 3;
  render::HairInput input = synthetic::hairInput(hair, 4000);
  input.look = synthetic::plainLook();
  input.segments_per_layer = 8;
  const auto strands = capture(input);
  const render::HairLayout layout = render::makeHairLayout(input.faces, input.positions);
  const std::vector<int> first = render::dealStrands(layout, input.strands);
  float longest_between = 0, worst_edge = 0;
  for (std::size_t face = 31; face < layout.faces.size(); face += 2) {
    for (int number = first[face]; number < first[face + 1]; ++number) {
      const auto p = Reference::facePoint(static_cast<std::uint32_t>(face),
                                          static_cast<std::uint32_t>(number - first[face]), input.look.seed);
      const float layers = static_cast<float>(strands[number].size() - 1) / 8;
      // In these faces the shared edges with shorter neighbours are v = 0 and v = 1; only columns of short bundles
      // remain.
      longest_between = std::max(longest_between, layers);
      if (p.y() < 0.05 || p.y() > 0.95) worst_edge = std::max(worst_edge, layers);
    }
  }
  EXPECT_LE(worst_edge, 5.0f + 0.05f * 3 + 0.13f);
  EXPECT_LE(longest_between, 8.0f);
  for (int number = first[30]; number < first[31]; ++number) EXPECT_EQ(strands[number].size(), 5u * 8 + 1);
}

TEST_F(StrandCapture, StrandsTurnSmoothly) {
  const synthetic::Hair hair = synthetic::makeHair();
  const auto sharpestTurn = [&](int segments) {
    render::HairInput input = synthetic::hairInput(hair, 500);
    input.look = synthetic::plainLook();
    input.segments_per_layer = segments;
    float sharpest = 0;
    for (const Polyline& strand : capture(input)) {
      for (std::size_t i = 2; i < strand.size(); ++i) {
        const Vector3f a = strand[i - 1] - strand[i - 2], b = strand[i] - strand[i - 1];
        sharpest = std::max(sharpest, std::atan2(a.cross(b).norm(), a.dot(b)));
      }
    }
    return sharpest;
  };
  // A continuous direction: twice the segments, about half the turn. A kink would keep its angle.
  EXPECT_LT(sharpestTurn(8), 0.68f * sharpestTurn(4));
}

TEST_F(StrandCapture, VariationIsDecidedBySeedAlone) {
  const synthetic::Hair hair = synthetic::makeHair();
  render::HairInput input = synthetic::hairInput(hair, 300);
  const auto once = capture(input), again = capture(input);
  EXPECT_EQ(once, again);
  input.look.seed = 2;
  EXPECT_NE(once, capture(input));
}

TEST_F(StrandCapture, VariationIsTheSameWhereverTheHeadStandsAtFirst) {
  const synthetic::Hair hair = synthetic::makeHair();
  synthetic::Hair moved = hair;
  const Vector3f axis(0.3f, 1, 0.2f);
  const Eigen::AngleAxisf turn(0.7f, axis.normalized());
  const Vector3f shift(1.5f, -0.3f, 2);
  for (std::size_t v = 0; v < hair.positions.size(); v += 3) {
    const Vector3f p = turn * Vector3f(hair.positions[v], hair.positions[v + 1], hair.positions[v + 2]) + shift;
    std::copy(p.data(), p.data() + 3, moved.positions.begin() + static_cast<long>(v));
  }
  const auto here = capture(synthetic::hairInput(hair, 300)), there = capture(synthetic::hairInput(moved, 300));
  int apart = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    ASSERT_EQ(here[i].empty(), there[i].empty());
    if (here[i].empty()) continue;  // left out at the hairline
    const Vector3f expected = turn * here[i].back() + shift;
    apart += (expected - there[i].back()).norm() > 1e-4f;
  }
  EXPECT_LE(apart, 3);  // rounding may hand a strand on the border of two clumps to the other one
}

TEST_F(StrandCapture, AHairCollapsedOntoItsRootsStaysFinite) {
  synthetic::Hair hair = synthetic::makeHair();
  for (std::size_t column = 0; column < hair.positions.size() / 3 / hair.layers; ++column) {
    for (int layer = 1; layer < hair.layers; ++layer) {
      for (int axis = 0; axis < 3; ++axis) {
        hair.positions[3 * (column * hair.layers + layer) + axis] = hair.positions[3 * column * hair.layers + axis];
      }
    }
  }
  for (const Polyline& strand : capture(synthetic::hairInput(hair, 200))) {
    for (const Vector3f& point : strand) ASSERT_TRUE(point.allFinite());
  }
}

TEST(StrandPatch, FacesMeetOnTheirSharedEdgesInEveryLayer) {
  const synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  const Reference reference(layout, hair.positions);
  const auto cornerPoint = [](bool triangle, int k) {
    if (triangle) return strand_reference::Vec2(k == 1, k == 2);
    return strand_reference::Vec2(k == 1 || k == 2, k >= 2);
  };
  struct Side {
    int face, from, to;
  };
  std::map<std::pair<int, int>, std::vector<Side>> sides;
  for (int face = 0; face < static_cast<int>(layout.faces.size()); ++face) {
    const auto& columns = layout.face_columns[face];
    const int corners = columns[3] < 0 ? 3 : 4;
    for (int k = 0; k < corners; ++k) {
      const int next = (k + 1) % corners;
      const bool turned = columns[k] > columns[next];
      const std::pair key{std::min(columns[k], columns[next]), std::max(columns[k], columns[next])};
      sides[key].push_back(turned ? Side{face, next, k} : Side{face, k, next});
    }
  }
  int shared_edges = 0, mixed_edges = 0;
  for (const auto& [key, pair] : sides) {
    if (pair.size() != 2) continue;
    ++shared_edges;
    std::array<bool, 2> triangle{};
    for (int i = 0; i < 2; ++i) triangle[i] = layout.face_columns[pair[i].face][3] < 0;
    mixed_edges += triangle[0] != triangle[1];
    for (int layer = 0; layer < hair.layers; ++layer) {
      for (double t : {0.0, 0.2, 0.5, 0.9}) {
        std::array<strand_reference::Vec3, 2> at;
        for (int i = 0; i < 2; ++i) {
          const strand_reference::Vec2 p =
              (1 - t) * cornerPoint(triangle[i], pair[i].from) + t * cornerPoint(triangle[i], pair[i].to);
          at[i] = reference.patch(pair[i].face, p, layer);
        }
        ASSERT_LT((at[0] - at[1]).norm(), 1e-7);
      }
    }
  }
  EXPECT_GT(shared_edges, 60);
  EXPECT_EQ(mixed_edges, 10);
}

TEST(HairLayout, GradientsOfAnAffineLayerAreExact) {
  const synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  Eigen::Matrix<float, 3, 2> slope;
  slope << 1.2f, 0.1f, -0.3f, 0.8f, 0.2f, 0.5f;
  // Around every column in turn: its neighbours displaced by an affine map of their tangent plane offsets.
  for (const render::HairColumn& column : layout.columns) {
    std::vector<float> positions(hair.positions.size(), 0.0f);
    for (const render::ColumnNeighbour& neighbour : column.neighbours) {
      const Vector3f p = slope * neighbour.offset;
      std::copy(p.data(), p.data() + 3, positions.begin() + 3 * layout.columns[neighbour.column].first_vertex);
    }
    std::vector<Eigen::Matrix<float, 3, 2>> gradients;
    render::inLayerGradients(layout, positions, gradients);
    EXPECT_LT((gradients[column.first_vertex] - slope).norm(), 0.01f * slope.norm());
  }
}

TEST(HairLayout, StrandsAreDealtByAreaAndNoneIsLost) {
  const synthetic::Hair hair = synthetic::makeHair();
  const render::HairLayout layout = render::makeHairLayout(hair.faces, hair.positions);
  float total = 0;
  for (const render::HairFace& face : layout.faces) total += face.area;
  for (int strands : {0, 1, 17, 20000}) {
    const std::vector<int> first = render::dealStrands(layout, strands);
    EXPECT_EQ(first.back(), strands);
    for (std::size_t i = 0; i < layout.faces.size(); ++i) {
      EXPECT_NEAR(first[i + 1] - first[i], strands * layout.faces[i].area / total, 1.001);
    }
  }
}

TEST(HairLayout, FacesThatCannotCarryStrandsAreLeftOut) {
  const synthetic::Hair hair = synthetic::makeHair();
  std::vector<render::HairFace> faces(hair.faces.begin(), hair.faces.end());
  faces[0].layers = 1;
  faces[1].first_vertex[2] = 1 << 20;
  faces[2].first_vertex[0] = -5;
  EXPECT_EQ(render::makeHairLayout(faces, hair.positions).faces.size(), hair.faces.size() - 3);
  EXPECT_TRUE(render::makeHairLayout(hair.faces, {}).faces.empty());
}

TEST(FiberScattering, ReturnsAllLightWithoutAbsorptionAndLessWithIt) {
  render::HairLook look;
  look.eumelanin = look.pheomelanin = 0;
  const auto albedoOf = [](const render::HairLook& of) {
    const render::FiberScattering s = render::tabulateScattering(of);
    return s.forward_albedo[1] + s.backward_albedo[1];
  };
  for (float roughness : {0.15f, 0.3f, 0.6f}) {
    look.beta_n = roughness;
    EXPECT_NEAR(albedoOf(look), 1.0f, 0.02f);
  }
  float before = 1.02f;
  for (float eumelanin : {0.3f, 1.3f, 8.0f}) {
    look.eumelanin = eumelanin;
    const float albedo = albedoOf(look);
    EXPECT_LT(albedo, before);
    before = albedo;
  }
}

TEST(FiberScattering, PickedColoursAbsorbWhatTheyLack) {
  render::HairLook look;
  look.use_color = true;
  look.color = {0.8f, 0.4f, 0.1f};
  const render::Float3 sigma = render::absorptionOf(look);
  EXPECT_LT(sigma[0], sigma[1]);
  EXPECT_LT(sigma[1], sigma[2]);
  look.color = {0, 0, 0};
  for (float s : render::absorptionOf(look)) EXPECT_TRUE(std::isfinite(s));
}

// A box beside the view is seen once it is swept across it, and not when it is swept away.
TEST(Frustum, SeesWhatIsSweptIntoIt) {
  render::CameraInput camera;
  camera.eye = {0, 1, 5};
  camera.target = {0, 1, 0};
  const render::Frustum view(render::cameraMatrix(camera, 1.5f), 0);
  for (const float side : {-1.0f, 1.0f}) {
    render::Bounds box;
    box.add(Vector3f(side * 20, 0.9f, -0.1f));
    box.add(Vector3f(side * 20.2f, 1.1f, 0.1f));
    EXPECT_FALSE(view.maySee(box));
    EXPECT_TRUE(view.maySeeSwept(box, Vector3f(-side * 40, 0, 0)));
    EXPECT_FALSE(view.maySeeSwept(box, Vector3f(side * 40, 0, 0)));
    EXPECT_FALSE(view.maySeeSwept(box, Vector3f(0, -40, 0)));
  }
}

// Shift and rise move the whole picture by so many half sides, and none changes no bit.
TEST(Frustum, AShiftMovesThePictureAsAWhole) {
  render::CameraInput camera;
  camera.eye = {0.3f, 1, 5};
  camera.target = {0, 1.2f, 0};
  const Eigen::Matrix4f plain = render::cameraMatrix(camera, 1.5f);
  EXPECT_FALSE(std::signbit(render::perspective(0.6f, 1.5f, 0.05f, 60)(0, 2)));
  EXPECT_FALSE(std::signbit(render::perspective(0.6f, 1.5f, 0.05f, 60)(1, 2)));
  camera.shift = 0.25f, camera.rise = -0.5f;
  const Eigen::Matrix4f shifted = render::cameraMatrix(camera, 1.5f);
  for (const Vector3f& p : {Vector3f(0, 1, 0), Vector3f(1, 0.5f, -3), Vector3f(-0.4f, 1.4f, 2)}) {
    const Eigen::Vector4f at(p.x(), p.y(), p.z(), 1), before = plain * at, after = shifted * at;
    EXPECT_NEAR(after.x() / after.w(), before.x() / before.w() + 0.25f, 1e-5f);
    EXPECT_NEAR(after.y() / after.w(), before.y() / before.w() - 0.5f, 1e-5f);
    EXPECT_EQ(after.z(), before.z());
    EXPECT_EQ(after.w(), before.w());
  }
}

}  // namespace strand_test
