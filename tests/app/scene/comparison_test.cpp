// A/B: the same settings stay together to the bit, others part, and the picture shows both.
#include "app/scene/comparison.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/files/image_io.h"
#include "app/files/recording.h"
#include "app/files/text_file.h"
#include "app/scene/demo.h"
#include "tests/app/scene/small_scene.h"
#include "tests/run_program.h"

namespace comparison_test {

using app::Ask;

app::Demo shaken() {
  return app::openScene(test::smallScene("head_shake.bvh", 0.2), 1.5);
}

void play(int frames, app::Demo& demo) {
  for (int frame = 0; frame < frames; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
}

TEST(Comparison, TheSameSettingsStayTogetherToTheBit) {
  app::Demo demo = shaken();
  play(12, demo);
  demo.requests = {{Ask::kCompare, "", "", 1}};
  play(30, demo);
  ASSERT_TRUE(demo.comparison.on()) << demo.message;
  EXPECT_EQ(demo.comparison.worst, 0);
  EXPECT_EQ(app::stateHash(demo), app::stateHash(demo.comparison.other.front()));
  // A parameter is asked of the first one alone; pausing stops both.
  demo.requests = {{Ask::kSetParam, "bend", "0.01"}};
  play(30, demo);
  EXPECT_GT(demo.comparison.now.rms, 1e-5);
  EXPECT_GE(demo.comparison.now.worst, demo.comparison.now.rms);
  demo.requests = {{Ask::kPause, "", "", 1}};
  play(1, demo);
  const std::string here = app::stateHash(demo.comparison.other.front());
  play(5, demo);
  EXPECT_EQ(app::stateHash(demo.comparison.other.front()), here);
  demo.requests = {{Ask::kCompare, "", "", 0}};
  play(1, demo);
  EXPECT_FALSE(demo.comparison.on());
}

TEST(Comparison, PresetsSettingsAndOtherHairAreComparedWith) {
  app::Demo demo = shaken();
  for (const char* with : {"soft", "density=120,friction=0.1", "bob_example.obj"}) {
    app::startComparison(with, demo);
    play(20, demo);
    EXPECT_EQ(demo.actors[0].playback.time, demo.comparison.other.front().actors[0].playback.time) << with;
    const bool other_hair = std::string(with).ends_with(".obj");
    EXPECT_EQ(demo.comparison.worst > 1e-4, !other_hair) << with;
    EXPECT_NE(app::comparisonText(demo).find(other_hair ? "other hair" : "mm RMS in the mean"), std::string::npos);
    EXPECT_NE(app::comparisonText(demo).find("a frame in the mean against"), std::string::npos);
  }
  const std::string with = demo.comparison.with;
  demo.requests = {{Ask::kCompare, "", "no such preset", 1}};
  play(1, demo);
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_EQ(demo.comparison.with, with) << "what was there stays";
}

TEST(Comparison, APictureHasTheFirstOneLeftOfTheLine) {
  const std::string folder = test::freshFolder("comparison");
  const auto draw = [&](const std::string& name, std::vector<std::string> words) {
    words.insert(words.end(), {"--headless", "--frames", "2", "--size", "160x120", "--strands", "400", "--style",
                               "short", "--resolution", "low", "--out", folder + "/" + name});
    return test::runProgram(words);
  };
  if (draw("plain", {}).exit_code == 3) GTEST_SKIP() << "no OpenGL";
  const test::Outcome split = draw("split", {"--compare", "blond", "--report", folder + "/report.json"});
  ASSERT_EQ(split.exit_code, 0) << split.err;
  EXPECT_NE(split.out.find("against blond: hair apart by"), std::string::npos) << split.out;
  EXPECT_NE(split.out.find("ms of both, compared"), std::string::npos) << split.out;
  const nlohmann::json report = nlohmann::json::parse(app::readText(folder + "/report.json", 1 << 20));
  const double length = report["characters"][0]["hair_length_metres"];
  const nlohmann::json apart = report["comparison"]["hair_apart"];
  EXPECT_NEAR(apart["rms_over_length_mean"].get<double>() * length, apart["rms_metres_mean"].get<double>(), 1e-12);
  EXPECT_EQ(report["comparison"]["frames"], 1) << "the first shows the start";
  ASSERT_EQ(draw("side", {"--compare", "blond", "--compare-view", "side"}).exit_code, 0);
  const auto picture = [&](const std::string& name) { return app::readPng(folder + "/" + name + "/frame_0001.png"); };
  const app::Image plain = picture("plain"), both = picture("split"), side = picture("side");
  ASSERT_EQ(both.width, 160);
  ASSERT_EQ(side.width, 160);
  long left = 0, right = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      const std::size_t at = 4 * (static_cast<std::size_t>(y) * 160 + static_cast<std::size_t>(x));
      if (x > 77 && x < 83) continue;
      (x < 80 ? left : right) += std::abs(plain.rgba[at] - both.rgba[at]);
    }
  }
  EXPECT_EQ(left, 0);
  EXPECT_GT(right, 500);
}

}  // namespace comparison_test
