// The scalp under hair: where it is, how deep the roots lie in it, and what the picture makes of it.
#include "app/figure/root_cover.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
#include "app/scene/sim_to_render.h"
#include "app/styles/style_roots.h"
#include "render/light/fiber_scattering.h"
#include "render/renderer.h"
#include "tests/gl_fixture.h"
#include "tests/golden_compare.h"

namespace root_cover_test {

using app::Character;
using app::Vec3;

const Character& mannequin() {
  static const Character character = app::loadCharacter(app::findFile("idle_turns.bvh", "", "clips"));
  return character;
}

const sim::HairMesh& longHair(app::Resolution resolution) {
  static const app::BodyDistance distance = app::restBodyDistance(mannequin());
  static const sim::HairMesh low = sim::buildHairMesh(
                                 app::makeStyle(app::Style::kLong, app::Resolution::kLow, mannequin().scalp, distance)),
                             high = sim::buildHairMesh(app::makeStyle(app::Style::kLong, app::Resolution::kHigh,
                                                                      mannequin().scalp, distance));
  return resolution == app::Resolution::kLow ? low : high;
}

// The skin's vertex nearest to a place seen from the middle of the cranium.
std::size_t vertexAt(double azimuth, double elevation) {
  const Character& character = mannequin();
  const app::Rigid scalp = app::scalpToWorld(character, app::restPose(character.skeleton));
  const Vec3 place = scalp * app::skinPoint(character.scalp, app::scalpDirection(azimuth, elevation));
  const auto& positions = character.mesh.positions;
  const auto nearest = std::min_element(positions.begin(), positions.end(), [&](const auto& a, const auto& b) {
    return (a.template cast<double>() - place).norm() < (b.template cast<double>() - place).norm();
  });
  return static_cast<std::size_t>(nearest - positions.begin());
}

TEST(RootCover, HoldsTheWholeScalpWithItsPartingAndNothingElse) {
  for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kHigh}) {
    const std::vector<float> cover = app::rootCover(mannequin(), longHair(resolution));
    const auto at = [&](double azimuth, double elevation) { return cover[2 * vertexAt(azimuth, elevation)]; };
    ASSERT_EQ(cover.size(), 2 * mannequin().mesh.positions.size());
    // Near the forehead the low resolution has the hairline close by.
    for (const double elevation : {48.0, 60.0, 75.0}) EXPECT_GT(at(13, elevation), 0.8) << "parting at " << elevation;
    EXPECT_GT(at(180, 20), 0.95) << "back of the head";
    const double bare[][2] = {{0, 10}, {30, -20}, {180, -55}};  // brow, cheek, neck
    for (const auto& [azimuth, elevation] : bare) {
      EXPECT_EQ(at(azimuth, elevation), 0) << azimuth;
      EXPECT_EQ(cover[2 * vertexAt(azimuth, elevation) + 1], 0) << "bare skin stays where it is";
    }
    for (std::size_t v = 0; v < cover.size() / 2; ++v) EXPECT_LE(cover[2 * v + 1], 0.013f);
  }
}

// Hair thins towards the hairline, and what the roots shade with it: in full there, the skin ends in a line as of a
// cap.
TEST(RootCover, ThinsTowardsTheHairlineAsHairDoes) {
  const sim::HairMesh& hair = longHair(app::Resolution::kHigh);
  const std::vector<float> cover = app::rootCover(mannequin(), hair);
  const app::SkinnedMesh& mesh = mannequin().mesh;
  const app::Rigid scalp = app::scalpToWorld(mannequin(), app::restPose(mannequin().skeleton));
  std::map<std::pair<int, int>, int> faces;  // on an edge of the root mesh
  for (const sim::RootFace& face : hair.shape.root_faces) {
    for (int k = 0; k < face.corner_count; ++k) {
      const auto ends = std::minmax(face.columns[k], face.columns[(k + 1) % face.corner_count]);
      ++faces[{ends.first, ends.second}];
    }
  }
  double most = 0;
  int looked = 0;
  for (const auto& [ends, count] : faces) {
    const Vec3 between = 0.5 * (hair.shape.positions[hair.shape.column_first[ends.first]] +
                                hair.shape.positions[hair.shape.column_first[ends.second]]);
    // The parting, and the seam between bundles over the ear, have hair on both sides.
    const Vec3 from = between - mannequin().scalp.center;
    const bool inside = from.y() > 0.5 * from.norm() || std::abs(from.z()) < 0.03;
    if (count != 1 || inside) continue;
    const Vec3 middle = scalp * between;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if ((mesh.positions[v].cast<double>() - middle).norm() > 0.003) continue;
      most = std::max<double>(most, cover[2 * v]);
      ++looked;
    }
  }
  EXPECT_GT(looked, 10);
  EXPECT_LT(most, 0.5);
}

TEST(RootCover, FadesWithoutAnEdge) {
  const std::vector<float> cover = app::rootCover(mannequin(), longHair(app::Resolution::kLow));
  const app::SkinnedMesh& mesh = mannequin().mesh;
  double steepest = 0;  // 1/m
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::size_t a = mesh.triangles[i], b = mesh.triangles[i % 3 == 2 ? i - 2 : i + 1];
    const double apart = std::max<double>((mesh.positions[a] - mesh.positions[b]).norm(), 0.002);
    steepest = std::max(steepest, std::abs(cover[2 * a] - cover[2 * b]) / apart);
  }
  EXPECT_LT(steepest, 1 / 0.0035) << "from none to all takes 3.5 mm or more";
  EXPECT_GT(steepest, 1 / 0.03) << "and it does fade somewhere";
}

// Without the depth the middle of a root face of the low resolution lies up to 11 mm inside the head.
TEST(RootCover, TheSkinIsDrawnBelowTheRoots) {
  const sim::HairMeshShape& shape = longHair(app::Resolution::kLow).shape;
  const std::vector<float> cover = app::rootCover(mannequin(), longHair(app::Resolution::kLow));
  const app::SkinnedMesh& mesh = mannequin().mesh;
  const app::Rigid scalp = app::scalpToWorld(mannequin(), app::restPose(mannequin().skeleton));
  double deepest_before = 0, deepest = 0;  // m
  for (const sim::RootFace& face : shape.root_faces) {
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < face.corner_count; ++k)
      middle += shape.positions[shape.column_first[face.columns[k]]] / face.corner_count;
    middle = scalp * middle;
    std::size_t nearest = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      if ((mesh.positions[v].cast<double>() - middle).norm() < (mesh.positions[nearest].cast<double>() - middle).norm())
        nearest = v;
    }
    const double depth = (mesh.positions[nearest].cast<double>() - middle).dot(mesh.normals[nearest].cast<double>());
    deepest_before = std::max(deepest_before, depth);
    deepest = std::max(deepest, depth - cover[2 * nearest + 1]);
  }
  EXPECT_GT(deepest_before, 0.01);
  EXPECT_LT(deepest, 0.001);
}

TEST(RootCover, OfAHairMeshThatIsNotOnTheHeadThereIsNone) {
  sim::HairMeshShape shape = longHair(app::Resolution::kLow).shape;
  for (sim::Vec3& p : shape.positions) p = mannequin().scalp.center + 1.4 * (p - mannequin().scalp.center);
  const std::vector<float> cover = app::rootCover(mannequin(), sim::buildHairMesh(shape));
  EXPECT_EQ(*std::max_element(cover.begin(), cover.end()), 0);
}

TEST(RootColor, DarkHairLeavesLessLightThanFairHair) {
  render::HairLook black, fair;
  black.eumelanin = 4;
  fair.eumelanin = 0.2f;
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(render::rootColor(black)[c], render::rootColor(fair)[c]);
    EXPECT_LT(render::rootColor(fair)[c], 1);
    EXPECT_GE(render::rootColor(black)[c], 0);
  }
}

app::Scene sceneOf(std::vector<app::CharacterSpec> characters) {
  app::Scene scene;
  for (app::CharacterSpec& spec : characters) spec.motion = app::findFile("idle_turns.bvh", "", "clips");
  scene.characters = std::move(characters);
  scene.playback.settle = 0;
  return scene;
}

app::CharacterSpec longLow(int strands) {
  app::CharacterSpec spec;
  spec.style = app::Style::kLong;
  spec.resolution = app::Resolution::kLow;
  spec.look.strands = strands;
  return spec;
}

TEST(RootCover, IsSharedByAllOfOneBodyUnderOneHaircut) {
  app::CharacterSpec other = longLow(100);
  other.style = app::Style::kShort;
  app::Demo demo = app::openScene(sceneOf({longLow(100), longLow(100), other}), 1);
  EXPECT_EQ(demo.actors[0].scalp, demo.actors[1].scalp);
  EXPECT_NE(demo.actors[0].scalp, demo.actors[2].scalp);
  demo.actors.pop_back();
  app::tidy(demo.actors, demo.asset_cache);
  ASSERT_EQ(demo.asset_cache.covers.size(), 1u);
  EXPECT_EQ(demo.asset_cache.covers[0].get(), demo.actors[0].scalp);
}

// The head from in front and above, close or far.
class ScalpPicture : public gl_fixture::GlTest {
 protected:
  static constexpr int kWidth = 320, kHeight = 240;

  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    demo_ = std::make_unique<app::Demo>(app::openScene(sceneOf({longLow(6000)}), 4.0 / 3));
    renderer_ = std::make_unique<render::Renderer>(gl_fixture::kShaderDir);
  }

  app::Image draw(float tint, double distance, bool show_strands = true, render::FrameReport* report = nullptr) {
    app::Actor& actor = demo_->actors[0];
    actor.spec.look.scalp_tint = tint;
    app::showActor(1, app::Vec3::Zero(), actor);
    render::FrameInput frame = app::frameInput(*demo_, kWidth, kHeight);
    const Vec3 middle = place(13, 55), ahead = (place(13, 55) - place(180, -55)).normalized();
    const Vec3 eye = middle + distance * (ahead + Vec3(0, 0.6, 0)).normalized();
    frame.camera.eye = app::toFloat3(eye);
    frame.camera.target = app::toFloat3(middle);
    frame.camera.fov_y = 0.43f;
    frame.light.to_light = app::toFloat3(ahead + Vec3(0, 1, 0));
    frame.view.show_strands = show_strands;
    camera_ = frame.camera;
    app::Image image{kWidth, kHeight, {}};
    const render::FrameReport drawn = renderer_->renderImage(frame, image.rgba);
    if (report != nullptr) *report = drawn;
    return image;
  }

  // World, of the skin.
  Vec3 place(double azimuth, double elevation) const {
    const app::Actor& actor = demo_->actors[0];
    const Character& character = actor.body->character;
    return app::scalpToWorld(character, actor.shown_pose) *
           app::skinPoint(character.scalp, app::scalpDirection(azimuth, elevation));
  }

  // Mean of all channels over (2 reach + 1)^2 pixels around a place of the head.
  double brightness(const app::Image& image, double azimuth, double elevation, int reach) const {
    const auto vector = [](const render::Float3& f) { return Eigen::Vector3d(f[0], f[1], f[2]); };
    const Eigen::Vector3d back = (vector(camera_.eye) - vector(camera_.target)).normalized(),
                          right = Eigen::Vector3d::UnitY().cross(back).normalized(), up = back.cross(right);
    const Eigen::Vector3d from = place(azimuth, elevation) - vector(camera_.eye);
    const double pixels = 0.5 * kHeight / std::tan(0.5 * camera_.fov_y) / -from.dot(back);
    const int x = static_cast<int>(0.5 * kWidth + pixels * from.dot(right)),
              y = static_cast<int>(0.5 * kHeight - pixels * from.dot(up));
    double sum = 0;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const auto p = 4 * (static_cast<std::size_t>(y + dy) * kWidth + static_cast<std::size_t>(x + dx));
        for (std::size_t c = 0; c < 3; ++c) sum += image.rgba.at(p + c) / 3.0;
      }
    }
    return sum / ((2 * reach + 1) * (2 * reach + 1));
  }

  std::unique_ptr<app::Demo> demo_;
  std::unique_ptr<render::Renderer> renderer_;
  render::CameraInput camera_;
};

TEST_F(ScalpPicture, ThePartingIsDarkerThanTheFaceAndTheFaceStaysAsItIs) {
  const app::Image bare = draw(0, 0.6), tinted = draw(0.8f, 0.6);
  double bare_parting = 0, tinted_parting = 0;
  for (const double elevation : {48.0, 52.0, 56.0, 60.0}) {
    bare_parting += brightness(bare, 13, elevation, 1) / 4;
    tinted_parting += brightness(tinted, 13, elevation, 1) / 4;
  }
  const double face = brightness(bare, 10, 5, 4);
  std::printf("face %.0f, parting %.0f without, %.0f with tint\n", face, bare_parting, tinted_parting);
  EXPECT_LT(tinted_parting, 0.75 * bare_parting);
  EXPECT_LT(tinted_parting, 0.7 * face);
  for (const double azimuth : {-20.0, 0.0, 20.0})
    EXPECT_EQ(brightness(bare, azimuth, 5, 4), brightness(tinted, azimuth, 5, 4)) << "face at " << azimuth;
}

// Bodies that are small in the picture are lit by other shaders.
TEST_F(ScalpPicture, AFarHeadIsTintedToo) {
  render::FrameReport report;
  const app::Image bare = draw(0, 8, false), tinted = draw(0.8f, 8, false, &report);
  ASSERT_GT(report.skip_counts.body_detail.skipped, 0);
  EXPECT_LT(brightness(tinted, 13, 54, 1), 0.8 * brightness(bare, 13, 54, 1));
}

// Hair comes out of the skin where it roots: less of the skin shows than when it is drawn where the body's mesh has it.
TEST_F(ScalpPicture, LessSkinShowsAtThePartingWhereTheScalpIsLower) {
  demo_->actors[0].spec.look.body_color = {0, 0.3f, 0};
  demo_->actors[0].spec.look.strands = 20000;
  const auto skin = [](const app::Image& image) {
    int green = 0;  // pixels in the middle of the picture, where the parting is
    for (std::size_t p = 0; p < image.rgba.size(); p += 4) {
      const std::size_t x = p / 4 % kWidth, y = p / 4 / kWidth;
      const bool middle = x > kWidth * 2 / 5 && x < kWidth * 3 / 5 && y > kHeight / 6 && y < kHeight / 2;
      green += middle && image.rgba[p + 1] > 2 * image.rgba[p];
    }
    return green;
  };
  const int lower = skin(draw(0, 0.6));
  app::ScalpCover level = *demo_->actors[0].scalp;
  ++level.id;
  for (std::size_t i = 1; i < level.cover.size(); i += 2) level.cover[i] = 0;
  demo_->actors[0].scalp = &level;
  const int as_meshed = skin(draw(0, 0.6));
  std::printf("%d pixels of skin, %d with the skin as it is meshed\n", lower, as_meshed);
  EXPECT_GT(as_meshed, 200);
  EXPECT_LT(lower, 0.8 * as_meshed);
}

TEST_F(ScalpPicture, AScalpIsUploadedOnceAndATintAlone) {
  render::FrameReport first, again, other;
  draw(0.5f, 0.6, true, &first);
  draw(0.5f, 0.6, true, &again);
  EXPECT_EQ(again.bytes_uploaded, 0);
  draw(0.6f, 0.6, true, &other);
  EXPECT_GT(other.bytes_uploaded, 0);
  EXPECT_LT(other.bytes_uploaded, 256) << "a block of constants";
}

TEST_F(ScalpPicture, WithoutStrandsTheHeadIsBareAndRound) {
  demo_->actors[0].spec.look.strands = 0;
  const app::Image bald = draw(1, 0.6);
  demo_->actors[0].spec.look.strands = 6000;
  demo_->scene.look.view.show_strands = false;
  EXPECT_EQ(app::frameInput(*demo_, kWidth, kHeight).bodies[0].scalp_id, 0u);
  demo_->scene.look.view.show_strands = true;
  EXPECT_NE(app::frameInput(*demo_, kWidth, kHeight).bodies[0].scalp_id, 0u);
  EXPECT_GT(brightness(bald, 13, 55, 3), brightness(draw(1, 0.6), 13, 55, 3));
}

}  // namespace root_cover_test
