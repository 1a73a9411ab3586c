// A recorded run repeats itself to the bit, whatever was asked for in it; a hostile recording is refused with its line.
#include "app/files/recording.h"

#include <gtest/gtest.h>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "tests/run_program.h"

namespace recording_test {

using app::Ask;

app::Scene smallScene() {
  app::Scene scene;
  scene.name = "recorded";
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/dance.bvh");
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters.push_back(spec);
  scene.playback.settle = 0.1;
  return scene;
}

// What a person in a hurry does in 60 frames of uneven length.
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

// `act` is what happens before each frame. Returns the demo as it ended.
template <class Act>
app::Demo recordRun(const std::string& file, app::Scene scene, Act&& act) {
  app::Options options;
  options.record = file;
  options.width = 700;
  options.height = 900;
  app::Tape tape(options, scene);
  app::Demo demo = app::openScene(scene, tape.aspect());
  for (int frame = 0; frame < 60; ++frame) {
    act(frame, demo);
    app::advanceFrame(demo, tape.turn(frame, 0.001 * (1 + frame * 37 % 61), demo), {});
  }
  EXPECT_FALSE(tape.end(demo).differs);
  return demo;
}

std::string record(const std::string& file) {
  return app::stateHash(
      recordRun(file, smallScene(), [](int frame, app::Demo& demo) { demo.requests = asksOf(frame); }));
}

app::Tape::End replay(const std::string& file, std::string& state) {
  app::Options options;
  options.replay = file;
  app::Scene scene;
  app::Tape tape(options, scene);
  app::Demo demo = app::openScene(scene, tape.aspect());
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
  EXPECT_FALSE(end.differs) << end.message;
  EXPECT_NE(end.message.find(recorded), std::string::npos) << end.message;
}

// Two figures of which the camera's moves make one coarse, slow or unseen for a while, and the picture's height too.
TEST(Recording, HoldsFromWhereItWasSeen) {
  const std::string file = test::freshFolder("recording_view") + "/run.hmr";
  app::Scene scene = smallScene();
  scene.characters[0].resolution = app::Resolution::kMedium;
  scene.characters.push_back(scene.characters[0]);
  scene.characters[1].position = app::Vec3(1.5, 0, -12);
  bool coarse = false, unseen = false;
  int span = 1;
  const auto look = [&](int frame, app::Demo& demo) {
    if (frame >= 10 && frame < 20) app::zoom(-3, demo.camera);
    if (frame == 25) demo.picture_height = 300;
    if (frame >= 30 && frame < 40) app::orbit(30, 1, 300, demo.camera);
    if (frame == 35) demo.place = {0.6, 0.3, 0.7};
    if (frame == 45) app::zoom(30, demo.camera), app::pan(500, 0, 300, demo.camera);
    if (frame == 50) demo.requests = {{Ask::kSkip, "far-mesh", "", 0}, {Ask::kView, "back", "", 0}};
    for (const app::Actor& actor : demo.actors) {
      coarse |= actor.coarse.active;
      unseen |= actor.unseen;
      span = std::max(span, actor.detail.step_span);
    }
  };
  const std::string recorded = app::stateHash(recordRun(file, scene, look));
  EXPECT_TRUE(coarse && unseen && span > 1) << coarse << unseen << span;
  std::string replayed;
  const app::Tape::End end = replay(file, replayed);
  EXPECT_EQ(replayed, recorded) << end.message;
}

TEST(Recording, HoldsWhichSkipsWereOff) {
  const std::string file = test::freshFolder("recording_skips") + "/run.hmr";
  app::Scene scene = smallScene();
  scene.skips.on[app::kSkipFarSteps] = scene.skips.on[app::kSkipView] = false;
  recordRun(file, scene, [](int, app::Demo&) {});
  EXPECT_EQ(app::readRecording(test::readAll(file), file).scene.skips, scene.skips);
}

// Costs of a budget are counted, not timed, while a run is recorded or replayed.
TEST(Recording, ABudgetRepeatsItself) {
  const std::string file = test::freshFolder("recording_budget") + "/run.hmr";
  app::Scene scene = smallScene();
  scene.playback.budget_ms = 0.02;
  const app::Demo demo = recordRun(file, scene, [](int frame, app::Demo& running) {
    if (frame == 40) running.requests = {{Ask::kBudget, "", "", 5}};
  });
  EXPECT_TRUE(demo.governor.counted);
  EXPECT_GT(demo.governor.changes, 0) << "the budget did nothing";
  std::string replayed;
  const app::Tape::End end = replay(file, replayed);
  EXPECT_EQ(replayed, app::stateHash(demo)) << end.message;
}

// A small picture makes far figures coarser; a replay without pictures is as coarse.
TEST(Recording, TheProgramReplaysInAnotherSizeAndWithoutPictures) {
  const std::string folder = test::freshFolder("recording_size"), file = folder + "/run.hmr";
  const test::Outcome recorded = test::runProgram(
      {"--headless", "--out", folder, "--size", "60x120", "--frames", "12", "--style", "short", "--resolution",
       "medium", "--strands", "100", "--camera", "0,1.6,5,0,1.5,0", "--skip", "sleep=off", "--record", file});
  if (recorded.exit_code == 3) GTEST_SKIP() << recorded.err;
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  const test::Outcome without = test::runProgram({"--no-images", "--replay", file});
  EXPECT_EQ(without.exit_code, 0) << without.out << without.err;
  const test::Outcome wide = test::runProgram({"--headless", "--out", folder, "--size", "640x90", "--replay", file});
  EXPECT_EQ(wide.exit_code, 0) << wide.out << wide.err;
}

// Version 1 held no views.
TEST(Recording, AnOlderRecordingIsRead) {
  const app::Recording old = app::readRecording(
      "{\"hairmesh-recording\": 1}\n{\"characters\": [{\"motion\": \"walk.bvh\"}]}\n[0.5]\n", "old.hmr");
  ASSERT_EQ(old.frames.size(), 1u);
  EXPECT_FALSE(old.frames[0].view || old.aspect);
  EXPECT_EQ(old.scene.skips, app::SkipSet{});
}

TEST(Recording, AChangedTextIsToldThoughTheHairEndsAsRecorded) {
  const std::string folder = test::freshFolder("recording_unmoved");
  record(folder + "/run.hmr");
  std::string text = test::readAll(folder + "/run.hmr"), replayed;
  text.insert(text.find('\n'), " ");
  std::ofstream(folder + "/other.hmr") << text;
  const app::Tape::End end = replay(folder + "/other.hmr", replayed);
  EXPECT_TRUE(end.differs);
  EXPECT_NE(end.message.find("to the bit: "), std::string::npos) << end.message;
  EXPECT_NE(end.message.find("; but its text was changed after it was recorded\n"), std::string::npos) << end.message;
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
  const app::Tape::End edited = replay(folder + "/other.hmr", replayed);
  EXPECT_TRUE(edited.differs);
  EXPECT_NE(edited.message.find("; its text was changed after it was recorded\n"), std::string::npos) << edited.message;
  // Without a checksum both are possible.
  const std::size_t sum = text.find("\"checksum\""), end = text.find(',', sum);
  text.erase(sum, end + 1 - sum);
  std::ofstream(folder + "/plain.hmr") << text;
  const app::Tape::End plain = replay(folder + "/plain.hmr", replayed);
  EXPECT_NE(plain.message.find("; its text was changed after it was recorded, or another build"), std::string::npos)
      << plain.message;
}

// What another build or processor ends in looks like this: all that was recorded is as it was, but for its end.
app::Tape::End endMovedBy(const std::string& name, double metres) {
  const std::string file = test::freshFolder(name) + "/run.hmr";
  app::Options options;
  options.record = file;
  app::Scene scene = smallScene();
  app::Tape tape(options, scene);
  app::Demo demo = app::openScene(scene, tape.aspect());
  app::advanceFrame(demo, tape.turn(0, 0.02, demo), {});
  for (sim::Vec3& position : demo.actors[0].hair.positions) position.x() += metres;
  tape.end(demo);
  std::string replayed;
  return replay(file, replayed);
}

TEST(Recording, AnotherEndOfTheSameInputsIsOfAnotherBuildAndPassesWithinFiveMillimetres) {
  const app::Tape::End rounded = endMovedBy("recording_rounded", 1e-9);
  EXPECT_FALSE(rounded.differs);
  EXPECT_NE(rounded.message.find("ends less than 0.1 mm in the mean"), std::string::npos) << rounded.message;
  EXPECT_NE(rounded.message.find("within the 5 mm in the mean that pass; another build or kind of processor"),
            std::string::npos)
      << rounded.message;
  EXPECT_FALSE(endMovedBy("recording_nearly", 4.9e-3).differs);
  const app::Tape::End elsewhere = endMovedBy("recording_elsewhere", 8e-3);
  EXPECT_TRUE(elsewhere.differs);
  EXPECT_NE(elsewhere.message.find("ends 8 mm in the mean, 8 mm at most"), std::string::npos) << elsewhere.message;
  EXPECT_NE(elsewhere.message.find("farther than the 5 mm in the mean that pass"), std::string::npos)
      << elsewhere.message;
}

// Version 2 held no ends.
TEST(Recording, WithoutEndsAReplayCannotTellByHowMuch) {
  const std::string folder = test::freshFolder("recording_endless");
  record(folder + "/run.hmr");
  std::string text = test::readAll(folder + "/run.hmr"), replayed;
  text.replace(text.find("\"hairmesh-recording\":3"), 22, "\"hairmesh-recording\":2");
  const std::size_t at = text.find("{\"ends\""), state = text.find("\"state\":\"") + 9;
  ASSERT_LT(at, state);
  text.replace(state, 4, "zzzz");
  std::ofstream(folder + "/old.hmr") << text.substr(0, at) << text.substr(text.find('\n', at) + 1);
  const app::Tape::End end = replay(folder + "/old.hmr", replayed);
  EXPECT_TRUE(end.differs);
  EXPECT_EQ(end.message.find("mm"), std::string::npos) << end.message;
}

// Hair in the same place that goes elsewhere is another state.
TEST(Recording, TheStateIsPlacesAndVelocities) {
  app::Demo demo = app::openScene(app::readScene(R"({"characters": [{"motion": "walk.bvh"}]})", "walk"), 1.5);
  const std::string before = app::stateHash(demo);
  sim::HairState& hair = demo.actors[0].hair;
  for (sim::Vec3* value : {&hair.positions.back(), &hair.velocities.back()}) {
    const sim::Vec3 kept = *value;
    value->z() += 1e-9;
    EXPECT_NE(app::stateHash(demo), before);
    *value = kept;
  }
  EXPECT_EQ(app::stateHash(demo), before);
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
  const test::Outcome changed = test::runProgram({"--no-images", "--replay", folder + "/changed.hmr"});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_NE(changed.out.find("its text was changed after it was recorded"), std::string::npos) << changed.out;
  EXPECT_EQ(test::runProgram({"--no-images", "--replay", folder + "/missing.hmr"}).exit_code, 4);
  EXPECT_EQ(test::runProgram({"--no-images", "--record", file, "--replay", file}).exit_code, 2);
}

struct Hostile {
  const char* what;
  std::string lines;  // after the head and the scene
};

TEST(Recording, HostileTextIsRefusedWithItsLine) {
  const std::string scene = R"({"characters": [{"motion": "walk.bvh"}]})";
  const std::string head = "{\"hairmesh-recording\": 2, \"aspect\": 1.5, \"skips_off\": [\"sleep\"]}\n" + scene + "\n";
  const std::string view =
      R"({"target": [0, 0, 0], "yaw": 0, "pitch": 0, "distance": 2, "aspect": 1.5, "height": 720})";
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
      {"a view that lacks its rest", "[0.1, {\"yaw\": 1}]\n"},
      {"a view with more", "[0.1, {\"yaw\": 1, \"a\": 1, \"b\": 1, \"c\": 1, \"d\": 1, \"e\": 1}]\n"},
      {"two views", "[0.1, " + view + ", " + view + "]\n"},
      {"a view after a request", "[0.1, [\"pause\", \"\", \"\", 1], " + view + "]\n"},
      {"a picture without height", "[0.1, " + view.substr(0, view.size() - 4) + "0}]\n"},
      {"a height beyond all", "[0.1, " + view.substr(0, view.size() - 4) + "1e99}]\n"},
      {"a shift out of the picture", "[0.1, " + view.substr(0, view.size() - 1) + ", \"shift\": 1.5}]\n"},
      {"a rise out of the picture", "[0.1, " + view.substr(0, view.size() - 1) + ", \"rise\": -2.5}]\n"},
      {"a zoom of nothing", "[0.1, " + view.substr(0, view.size() - 1) + ", \"zoom\": 0}]\n"},
      {"a wrong count", "[0.1]\n{\"frames\": 7, \"state\": \"0\"}\n"},
      {"an enormous count", "{\"frames\": 1e300, \"state\": \"0\"}\n"},
      {"more after the end", "{\"frames\": 0, \"state\": \"0\"}\n[0.1]\n"},
      {"ends of no characters", "[0.1]\n{\"ends\": 3}\n"},
      {"ends that are no triples", "[0.1]\n{\"ends\": [[1, 2]]}\n"},
      {"ends that are text", "[0.1]\n{\"ends\": [[1, 2, \"3\"]]}\n"},
      {"ends beyond all", "[0.1]\n{\"ends\": [[1, 2, 1e300]]}\n"},
      {"two lines of ends", "[0.1]\n{\"ends\": [[1, 2, 3]]}\n{\"ends\": [[1, 2, 3]]}\n"},
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
  for (const char* text : {"", "{}", "{\"hairmesh-recording\": 2}\n", "{\"hairmesh-recording\": 4}\n",
                           "{\"hairmesh-recording\": 2, \"aspect\": 0, \"skips_off\": []}\n",
                           "{\"hairmesh-recording\": 2, \"aspect\": 1, \"skips_off\": [\"nap\"]}\n", "[]\n",
                           "{\"hairmesh-recording\": 1}\n", "{\"hairmesh-recording\": 1}\n{}\n", "OBJ"}) {
    EXPECT_THROW(app::readRecording(text, "x.hmr"), app::InputError) << text;
  }
  EXPECT_NO_THROW(app::readRecording(head + "[0]\n[0.1, [\"pause\", \"\", \"\", 1]]\n", "x.hmr"));
  EXPECT_NO_THROW(app::readRecording(head + "[0, " + view + ", [\"pause\", \"\", \"\", 1]]\n", "x.hmr"));
  const std::string shifted = view.substr(0, view.size() - 1) + ", \"shift\": -0.25}";
  EXPECT_EQ(app::readRecording(head + "[0, " + shifted + "]\n", "x.hmr").frames[0].view->place.shift, -0.25);
  const std::string placed = view.substr(0, view.size() - 1) + ", \"rise\": 0.125, \"zoom\": 0.75}";
  const app::ViewPlace wanted{0, 0.125, 0.75};
  EXPECT_EQ(app::readRecording(head + "[0, " + placed + "]\n", "x.hmr").frames[0].view->place, wanted);
}

}  // namespace recording_test
