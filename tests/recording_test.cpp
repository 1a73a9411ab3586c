// A recorded run repeats itself to the bit, whatever was asked for in it; a hostile recording is refused with its line.
#include "app/recording.h"

#include <gtest/gtest.h>

#include "app/data_path.h"
#include "app/errors.h"
#include "tests/run_program.h"

namespace {

using app::Ask;

app::Scene smallScene() {
  app::Scene scene;
  scene.name = "recorded";
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/dance.bvh");
  spec.style = sim::Style::kShort;
  spec.resolution = sim::Resolution::kLow;
  scene.characters.push_back(spec);
  scene.playback.settle = 0.1;
  return scene;
}

// What a restless person does in 60 frames of uneven length.
std::vector<app::Request> asksOf(int frame) {
  switch (frame) {
    case 5:
      return {{Ask::kSetParam, "gravity", "4.5", 0}, {Ask::kSpeed, "", "", 3.7}};
    case 12:
      return {{Ask::kCollapse, "", "", 0}};
    case 20:
      return {{Ask::kCarryAlong, "", "", 1.234567890123}, {Ask::kSetParam, "wind_x", "7", 0}};
    case 31:
      return {{Ask::kPause, "", "", 1}, {Ask::kSingleStep, "", "", 0}, {Ask::kSetParam, "no\nsuch \"row\"", "x", 0}};
    case 36:
      return {{Ask::kPause, "", "", 0}, {Ask::kReset, "", "", 0}};
    default:
      return {};
  }
}

std::string record(const std::string& file) {
  app::Options options;
  options.record = file;
  app::Scene scene = smallScene();
  app::Tape tape(options, scene);
  app::Demo demo = app::openScene(scene, 1.5);
  for (int frame = 0; frame < 60; ++frame) {
    demo.requests = asksOf(frame);
    app::advanceFrame(demo, tape.turn(frame, 0.001 * (1 + frame * 37 % 61), demo), {});
  }
  EXPECT_FALSE(tape.end(demo).differs);
  return app::stateHash(demo);
}

app::Tape::End replay(const std::string& file, std::string& state) {
  app::Options options;
  options.replay = file;
  app::Scene scene;
  app::Tape tape(options, scene);
  app::Demo demo = app::openScene(scene, 1.5);
  for (int frame = 0; frame < tape.frames(); ++frame) app::advanceFrame(demo, tape.turn(frame, 0.5, demo), {});
  state = app::stateHash(demo);
  return tape.end(demo);
}

TEST(Recording, AReplayEndsInTheRecordedStateToTheBit) {
  const std::string file = test::freshFolder("recording") + "/run.hmr";
  const std::string recorded = record(file);
  std::string replayed;
  const app::Tape::End end = replay(file, replayed);
  EXPECT_EQ(replayed, recorded);
  EXPECT_FALSE(end.differs) << end.said;
  EXPECT_NE(end.said.find(recorded), std::string::npos) << end.said;
}

TEST(Recording, AChangedInputShowsInTheEnd) {
  const std::string folder = test::freshFolder("recording_changed");
  record(folder + "/run.hmr");
  std::string text = test::readAll(folder + "/run.hmr");
  const std::size_t at = text.find("\"4.5\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 5, "\"4.6\"");
  std::ofstream(folder + "/other.hmr") << text;
  std::string replayed;
  EXPECT_TRUE(replay(folder + "/other.hmr", replayed).differs);
}

TEST(Recording, TheProgramRecordsAndReplays) {
  const std::string folder = test::freshFolder("recording_program"), file = folder + "/run.hmr";
  const test::Outcome recorded =
      test::runProgram({"--no-images", "--frames", "30", "--style", "short", "--resolution", "low", "--record", file});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const test::Outcome replayed = test::runProgram({"--no-images", "--replay", file});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_NE(replayed.out.find("to the bit"), std::string::npos) << replayed.out;
  std::string text = test::readAll(file);
  text.replace(text.rfind("\"state\":\"") + 9, 4, "zzzz");
  std::ofstream(folder + "/changed.hmr") << text;
  EXPECT_EQ(test::runProgram({"--no-images", "--replay", folder + "/changed.hmr"}).exit_code, 1);
  EXPECT_EQ(test::runProgram({"--no-images", "--replay", folder + "/missing.hmr"}).exit_code, 4);
  EXPECT_EQ(test::runProgram({"--no-images", "--record", file, "--replay", file}).exit_code, 2);
}

struct Hostile {
  const char* what;
  std::string lines;  // after the head and the scene
};

TEST(Recording, HostileTextIsRefusedWithItsLine) {
  const std::string scene = R"({"characters": [{"motion": "walk.bvh"}]})";
  const std::string head = "{\"hairmesh-recording\": 1}\n" + scene + "\n";
  const Hostile rows[] = {
      {"a frame without its length", "[]\n"},
      {"a length that is text", "[\"0.1\"]\n"},
      {"a negative length", "[-1]\n"},
      {"a length beyond all", "[1e300]\n"},
      {"a request that is no list", "[0.1, 3]\n"},
      {"a request too short", "[0.1, [\"pause\", \"\", \"\"]]\n"},
      {"an unknown request", "[0.1, [\"explode\", \"\", \"\", 0]]\n"},
      {"a request that writes a file", "[0.1, [\"save-scene\", \"\", \"/tmp/x\", 0]]\n"},
      {"a value that is no number", "[0.1, [\"pause\", \"\", \"\", null]]\n"},
      {"a wrong count", "[0.1]\n{\"frames\": 7, \"state\": \"0\"}\n"},
      {"an enormous count", "{\"frames\": 1e300, \"state\": \"0\"}\n"},
      {"more after the end", "{\"frames\": 0, \"state\": \"0\"}\n[0.1]\n"},
      {"an end without a state", "{\"frames\": 0}\n"},
      {"broken JSON", "[0.1\n"},
      {"deep JSON", std::string(100000, '[') + "\n"},
      {"an empty line", "\n[0.1]\n"},
  };
  for (const Hostile& row : rows) {
    try {
      app::readRecording(head + row.lines, "x.hmr");
      ADD_FAILURE() << row.what << " was taken";
    } catch (const app::InputError& error) {
      EXPECT_NE(std::string(error.what()).find("x.hmr, line "), std::string::npos) << row.what << ": " << error.what();
    }
  }
  for (const char* text : {"", "{}", "{\"hairmesh-recording\": 2}\n", "[]\n", "{\"hairmesh-recording\": 1}\n",
                           "{\"hairmesh-recording\": 1}\n{}\n", "OBJ"}) {
    EXPECT_THROW(app::readRecording(text, "x.hmr"), app::InputError) << text;
  }
  EXPECT_NO_THROW(app::readRecording(head + "[0]\n[0.1, [\"pause\", \"\", \"\", 1]]\n", "x.hmr"));
}

}  // namespace
