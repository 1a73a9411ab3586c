// Whatever the look tables allow, all at once, gives a picture: no value that is not a number, no black or white frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "app/scene/view/look_params.h"
#include "render/renderer.h"
#include "tests/gl_fixture.h"
#include "tests/synthetic_hair.h"

namespace random_look_test {

constexpr int kSize = 24, kLooks = 1000;  // pixels a side

// Both ends of every range, and what lies between.
template <class Field>
app::LookValue randomValue(const Field& row, std::mt19937& random) {
  app::LookValue value{};
  for (int c = 0; c < row.components(); ++c) {
    const double share = std::clamp(std::uniform_real_distribution<>(-0.5, 1.5)(random), 0.0, 1.0);
    value[c] = row.minimum + share * (row.maximum - row.minimum);
    if (row.kind != sim::FieldKind::kReal) value[c] = std::round(value[c]);
  }
  return value;
}

// Shaders that leave a pixel transparent when its radiance is not a finite number.
std::string markingShaders() {
  const std::string folder = gl_fixture::copyShaders("marking_shaders"), file = folder + "/tone_map.frag";
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  std::string marked = text.str();
  const std::size_t end = marked.rfind('}');
  marked.insert(end, "  if (any(isnan(sum)) || any(isinf(sum))) color = vec4(0.0);\n");
  std::ofstream(file) << marked;
  return folder;
}

struct Picture {
  int marked = 0;
  double mean = 0;  // of all channels, 0..1
};

Picture look(const std::vector<unsigned char>& rgba) {
  Picture picture;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    picture.marked += rgba[i + 3] == 0;
    picture.mean += (rgba[i] + rgba[i + 1] + rgba[i + 2]) / (3 * 255.0) / (rgba.size() / 4);
  }
  return picture;
}

class RandomLooks : public gl_fixture::GlTest {};

TEST_F(RandomLooks, GiveAPicture) {
  render::Renderer renderer(markingShaders());
  const synthetic::Hair hair = synthetic::makeHair(5);
  const synthetic::Body body = synthetic::makeBody();
  std::vector<render::HairInput> hairs{synthetic::hairInput(hair, 80)};
  std::vector<render::BodyInput> bodies{synthetic::bodyInput(body)};
  std::mt19937 random(11);
  std::vector<unsigned char> rgba;
  double darkest = 1, brightest = 0;
  for (int trial = 0; trial < kLooks; ++trial) {
    app::CharacterLook character;
    for (const app::HairField& row : app::hairFields()) row.set(character, randomValue(row, random));
    render::FrameInput frame = synthetic::frameInput(hairs, bodies, kSize, kSize);
    frame.light.shadow_size = 128;
    hairs[0].look = character.hair;
    bodies[0].color = character.body_color;
    bodies[0].roughness = character.body_roughness;
    renderer.renderImage(frame, rgba);
    const Picture seen = look(rgba);
    ASSERT_EQ(seen.marked, 0) << "look " << trial;
    darkest = std::min(darkest, seen.mean);
    brightest = std::max(brightest, seen.mean);
  }
  std::printf("%d looks: mean of a picture %.3f to %.3f\n", kLooks, darkest, brightest);
  EXPECT_GT(darkest, 0.03);
  EXPECT_LT(brightest, 0.85);
}

// Lights may be out or dazzle: such frames are black or white by right.
TEST_F(RandomLooks, OfHairLightAndViewAtOnceHoldNoValueThatIsNotANumber) {
  render::Renderer renderer(markingShaders());
  const synthetic::Hair hair = synthetic::makeHair(5);
  const synthetic::Body body = synthetic::makeBody();
  std::vector<render::HairInput> hairs{synthetic::hairInput(hair, 80)};
  std::vector<render::BodyInput> bodies{synthetic::bodyInput(body)};
  std::mt19937 random(12);
  std::vector<unsigned char> rgba;
  for (int trial = 0; trial < kLooks / 2; ++trial) {
    app::CharacterLook character;
    for (const app::HairField& row : app::hairFields()) row.set(character, randomValue(row, random));
    hairs[0].look = character.hair;
    bodies[0].color = character.body_color;
    bodies[0].roughness = character.body_roughness;
    app::SceneLook scene;
    for (const app::SceneField& row : app::sceneFields()) row.set(scene, randomValue(row, random));
    render::FrameInput frame = synthetic::frameInput(hairs, bodies, kSize, kSize);
    frame.light = scene.light;
    frame.light.shadow_size = std::min(frame.light.shadow_size, 512);
    frame.view = scene.view;
    frame.view.samples = std::min(frame.view.samples, 4);
    renderer.renderImage(frame, rgba);
    ASSERT_EQ(look(rgba).marked, 0) << "look " << trial;
  }
}

}  // namespace random_look_test
