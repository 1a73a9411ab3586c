// A groom that is curly on one side alone is drawn so: as it is read, and as the hair mesh that is made of it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "app/files/hair_file.h"
#include "app/files/output_file.h"
#include "app/groom/convert.h"
#include "app/groom/formats/hair_strands_file.h"
#include "app/groom/groom_file.h"
#include "app/scene/demo.h"
#include "app/scene/hair_from_file.h"
#include "tests/app/scene/small_scene.h"
#include "tests/groom_kinds.h"
#include "tests/run_program.h"

namespace grown_fields_test {

using Eigen::Vector3f;

// Swept back, 25 cm; curls of 3 mm where it roots left of the middle.
app::Groom curlyOnTheLeft(int strands) {
  const groom_kinds::Head head;
  app::Groom groom;
  for (int i = 0; i < strands; ++i) {
    const Vector3f root = head.surface(groom_kinds::rootDirection(i, strands));
    std::vector<Vector3f> line = groom_kinds::sweptBack(head, root, 0.25f, 129);
    const float phase = 6.2832f * groom_kinds::random(static_cast<std::uint32_t>(i) + 77u);
    if (root.x() > 0)
      groom_kinds::bendStrand(line, [&](float t) {
        const float turn = 6.2832f * 7 * t + phase;
        return Eigen::Vector2f(0.003f * groom_kinds::opened(t) * Eigen::Vector2f(std::cos(turn), std::sin(turn)));
      });
    groom_kinds::add(line, groom);
  }
  return groom;
}

// Mean share of the curls at roots left and right of the head's middle.
std::pair<double, double> curlShares(const app::Actor& actor) {
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  double sum[2] = {}, count[2] = {};
  for (int c = 0; c < shape.columnCount(); ++c) {
    const auto v = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]);
    const double x = shape.positions[v].x() - actor.body->character.scalp.center.x();
    if (std::abs(x) < 0.02) continue;
    const std::vector<render::LookShare>& roots = actor.haircut->look_shares.roots;
    sum[x > 0] += roots.empty() ? 1 : static_cast<double>(roots[v].curl);
    count[x > 0] += 1;
  }
  return {sum[1] / count[1], sum[0] / count[0]};
}

app::Demo opened(const std::string& hair, const render::HairLook& look) {
  app::Scene scene = test::smallScene("walk.bvh", 0);
  app::chooseHair(hair, scene.characters[0]);
  scene.characters[0].look.hair = look;
  return app::openScene(std::move(scene), 1.5);
}

TEST(GrownFields, CurlsOfOneSideAreDrawnThere) {
  const std::string folder = test::freshFolder("grown_fields"), file = folder + "/left.hair";
  const app::Groom groom = curlyOnTheLeft(800);
  app::OutputFile output(file);
  app::writeHairStrands(groom, file, output);
  output.commit();
  app::Demo demo = opened(file, {});
  app::Actor& actor = demo.actors[0];
  EXPECT_NEAR(actor.spec.look.hair.curl_radius, 0.003f, 0.0008f);
  EXPECT_TRUE(app::isPictureText(actor.spec.maps.curl)) << "the brush and a scene have it as a painted field";
  const auto [left, right] = curlShares(actor);
  EXPECT_GT(left, 0.8);
  EXPECT_LT(right, 0.1);

  // The hair mesh made of it, with its shares.
  app::ConvertOptions options;
  options.unit = 1;
  const app::Conversion conversion = app::convertGroom(groom, {}, options, file);
  app::writeFile(folder + "/left.obj", app::writeHairMesh(conversion.shape, conversion.look.columns));
  render::HairLook look;
  app::takeLook(conversion.look, look);
  app::Demo made = opened(folder + "/left.obj", look);
  const auto [made_left, made_right] = curlShares(made.actors[0]);
  EXPECT_GT(made_left, 0.8);
  EXPECT_LT(made_right, 0.1);

  // What a person takes away stays away, and another hair does not keep it.
  demo.requests = {{app::Ask::kMap, "curl", ""}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.actors[0].spec.maps.curl, "") << demo.message;
  EXPECT_TRUE(demo.actors[0].haircut->look_shares.roots.empty());
  made.requests = {{app::Ask::kStyle, "short", ""}};
  app::advanceFrame(made, 0, {});
  EXPECT_EQ(made.actors[0].spec.maps.curl, "") << made.message;
}

}  // namespace grown_fields_test
