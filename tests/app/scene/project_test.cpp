// A project goes on where it was left, to the bit; one that cannot be saved or opened leaves what there was.
#include "app/scene/project.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/file_kind.h"
#include "app/files/recording.h"
#include "app/files/text_file.h"
#include "app/scene/edit/groom_brush.h"
#include "tests/run_program.h"

namespace project_test {

using app::Ask;

app::Scene smallScene() {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::dataPath("assets/clips/walk.bvh");
  spec.style = app::Style::kShort;
  spec.resolution = app::Resolution::kLow;
  scene.characters = {spec};
  scene.playback.settle = 0.1;
  return scene;
}

// With another density and a brushed fringe, in the middle of a walk. `frames`: after the stroke.
app::Demo brushedDemo(int frames) {
  app::Demo demo = app::openScene(smallScene(), 1.5);
  app::BrushSample sample;
  const app::Actor& actor = demo.actors[0];
  sample.at = app::scalpToWorld(actor.body->character, actor.pose).inverse() * actor.hair.positions.back();
  sample.radius = 0.1;
  demo.requests = {{Ask::kSetParam, "density", "80"}, {Ask::kBrush, "cut", app::brushText(sample)}};
  sample.tool = app::BrushTool::kCut;
  for (int frame = 0; frame < frames; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
  EXPECT_TRUE(demo.actors[0].haircut->edited) << demo.message;
  return demo;
}

void goOn(int frames, app::Demo& demo) {
  for (int frame = 0; frame < frames; ++frame) app::advanceFrame(demo, 1.0 / 60, {});
}

double largestDifference(const app::Demo& a, const app::Demo& b) {
  double most = 0;
  for (std::size_t v = 0; v < a.actors[0].hair.positions.size(); ++v)
    most = std::max(most, (a.actors[0].hair.positions[v] - b.actors[0].hair.positions[v]).norm());
  return most;
}

TEST(Project, GoesOnWhereItWasLeftToTheBit) {
  const std::string file = test::freshFolder("project_plain") + "/mine.json";
  app::Demo demo = app::openScene(smallScene(), 1.5), other = app::openScene(smallScene(), 1.5);
  goOn(25, demo);
  app::saveProject(file, demo);
  app::openProject(file, other);
  goOn(30, demo);
  goOn(30, other);
  EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
}

TEST(Project, OpensFromTheCommandLineWithOtherSettingsButNoOtherHair) {
  const std::string file = test::freshFolder("project_line") + "/mine.json";
  app::Demo demo = app::openScene(smallScene(), 1.5);
  goOn(25, demo);
  app::saveProject(file, demo);
  const test::Outcome opened = test::runProgram({"--no-images", "--frames", "2", file});
  EXPECT_EQ(opened.exit_code, 0) << opened.err;
  const test::Outcome changed = test::runProgram({"--no-images", "--frames", "2", file, "--style", "short"});
  EXPECT_EQ(changed.exit_code, app::kExitUsage) << changed.err;
  EXPECT_NE(changed.err.find("leave out --style"), std::string::npos) << changed.err;
  const test::Outcome set = test::runProgram({"--no-images", "--frames", "2", file, "--camera", "back", "--fps", "24",
                                              "--preset", "stiff", "--set", "density=70", "--strands", "900"});
  EXPECT_EQ(set.exit_code, 0) << set.err;

  app::Scene scene = app::projectScene(file);
  scene.sim.density = 70;
  scene.camera.view = "back";
  scene.camera.eye.reset();
  scene.camera.target.reset();
  const app::Demo plain = app::readProject(file, app::projectScene(file), false, 1.5);
  const app::Demo other = app::readProject(file, scene, true, 1.5);
  EXPECT_EQ(other.scene.sim.density, 70);
  EXPECT_EQ(plain.camera.yaw, demo.camera.yaw);
  EXPECT_GT(std::abs(std::remainder(other.camera.yaw - plain.camera.yaw, 2 * EIGEN_PI)), 1);
  EXPECT_EQ(app::stateHash(other), app::stateHash(plain));
}

// Saved in the middle of a walk with a cut fringe, and paused.
TEST(Project, ARecordedRunOfOneReplaysToTheBitAndPlaysThoughItWasPaused) {
  const std::string folder = test::freshFolder("project_record"), file = folder + "/mine.json";
  app::Demo demo = brushedDemo(20);
  demo.paused = true;
  app::saveProject(file, demo);
  const std::string before = app::stateHash(demo);
  const test::Outcome run = test::runProgram({"--no-images", "--frames", "8", file, "--record", folder + "/run.take"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(app::readText(folder + "/run.take").find(before), std::string::npos) << "nothing moved";
  const test::Outcome replay = test::runProgram({"--no-images", "--replay", folder + "/run.take"});
  EXPECT_EQ(replay.exit_code, 0) << replay.err << replay.out;
  const test::Outcome changed = test::runProgram(
      {"--no-images", "--frames", "2", file, "--record", folder + "/other.take", "--set", "density=70"});
  EXPECT_EQ(changed.exit_code, app::kExitUsage) << changed.err;
}

// A recording begins with it by a request; undo ends where the person began.
TEST(Project, ThatARunBeginsWithIsNoStepOfItsHistory) {
  const std::string file = test::freshFolder("project_begins") + "/mine.json";
  app::Demo saved = brushedDemo(20), demo = app::openScene(smallScene(), 1.5);
  app::saveProject(file, saved);
  demo.requests = {{app::Ask::kOpenProject, "", file, 1}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(app::stateHash(demo), app::stateHash(saved));
  EXPECT_TRUE(demo.edits.steps.empty());
  demo.requests = {{app::Ask::kOpenProject, "", file, 0}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.edits.steps.size(), 1u) << "one that is opened later is a step";
}

TEST(Project, KeepsBrushedHairAndGoesOnWithIt) {
  const std::string file = test::freshFolder("project") + "/mine.json";
  app::Demo demo = brushedDemo(60);
  app::saveProject(file, demo);
  EXPECT_EQ(app::fileKind(file), app::FileKind::kProject);
  app::Demo other = app::openScene(smallScene(), 1.5);
  app::openProject(file, other);
  EXPECT_EQ(other.scene.sim.density, 80);
  EXPECT_EQ(other.actors[0].haircut->mesh.shape.positions, demo.actors[0].haircut->mesh.shape.positions);
  EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
  goOn(30, demo);
  goOn(30, other);
  EXPECT_LT(largestDifference(other, demo), 0.01 * demo.actors[0].haircut->mesh.hair_length);
  app::saveProject(file, other);
  int binaries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(file).parent_path()))
    binaries += entry.path().extension() == ".bin";
  EXPECT_EQ(binaries, 1) << "the binary of the one before is gone";
}

TEST(Project, AFullDiskLeavesTheOneThatWasThere) {
  const std::string file = test::freshFolder("project_full") + "/mine.json";
  app::Demo demo = brushedDemo(20);
  app::saveProject(file, demo);
  const std::string before = app::stateHash(demo);
  goOn(10, demo);
  rlimit limit{}, small{};
  getrlimit(RLIMIT_FSIZE, &limit);
  small = limit;
  small.rlim_cur = 2000;
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(app::saveProject(file, demo), app::OutputError);
  setrlimit(RLIMIT_FSIZE, &limit);
  app::openProject(file, demo);
  EXPECT_EQ(app::stateHash(demo), before);
}

TEST(Project, WhatIsNoneOrNewerOrChangedIsRefusedAndChangesNothing) {
  const std::string folder = test::freshFolder("project_bad"), file = folder + "/mine.json";
  app::Demo demo = brushedDemo(5);
  app::saveProject(file, demo);
  const std::string text = app::readText(file), state = app::stateHash(demo);
  const auto faultOf = [&](const std::string& changed) {
    std::ofstream(folder + "/bad.json") << changed;
    try {
      app::openProject(folder + "/bad.json", demo);
    } catch (const app::InputError& fault) {
      return std::string(fault.what());
    }
    return std::string("none");
  };
  std::string newer = text;
  newer.replace(newer.find("\"hairmesh-project\": 5"), 21, "\"hairmesh-project\": 6");
  EXPECT_NE(faultOf(newer).find("version 6, newer"), std::string::npos) << faultOf(newer);
  EXPECT_NE(faultOf("{}").find("is no project"), std::string::npos);
  EXPECT_NE(faultOf("[").find("bad.json"), std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".bin") std::ofstream(entry.path(), std::ios::app) << "x";
  }
  EXPECT_NE(faultOf(text).find("is not the one"), std::string::npos) << faultOf(text);
  EXPECT_EQ(app::stateHash(demo), state);
}

TEST(Project, ARunThatEndsWithoutLeavingIsOfferedAgain) {
  const std::string folder = test::freshFolder("project_autosave");
  app::Demo demo = brushedDemo(5);
  {
    app::Autosave autosave(folder);
    autosave.keep(100, demo);
    EXPECT_FALSE(std::filesystem::is_empty(folder));
    EXPECT_EQ(autosave.left(), "") << "this run goes on";
    // A process that is no more: its number is beyond all that are given.
    const std::string own = folder + "/autosave-" + std::to_string(getpid()) + ".json";
    std::filesystem::copy(own, folder + "/autosave-99999999.json");
    const std::string left = autosave.left();
    ASSERT_TRUE(left.ends_with("autosave-99999999.json"));
    app::Demo other = app::openScene(smallScene(), 1.5);
    app::openProject(left, other);
    EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
    autosave.replace(left);
  }
  EXPECT_FALSE(std::filesystem::exists(folder + "/autosave-99999999.json")) << "this run went on from it and ended";
  EXPECT_FALSE(std::filesystem::exists(folder + "/autosave-" + std::to_string(getpid()) + ".json"));
}

// The project that a run leaves when it crashes. `scene`: the file that it was opened with; empty: none.
std::string leftBy(const std::string& folder, const std::string& scene, app::Demo& demo) {
  demo.scene.file = scene;
  const std::string left = folder + "/autosave-99999999.json";
  app::Autosave autosave(folder + "/run");
  autosave.keep(100, demo);
  std::filesystem::copy(folder + "/run", folder);
  std::filesystem::rename(folder + "/autosave-" + std::to_string(getpid()) + ".json", left);
  return left;
}

TEST(Project, OneThatWasKeptByItselfIsOfTheSceneThatItWasKeptOf) {
  for (const std::string& scene : {std::string("/of/mine.json"), std::string("mine.json"), std::string()}) {
    app::Demo demo = brushedDemo(5);
    demo.scene.name = "mine";
    const std::string left = leftBy(test::freshFolder("project_autosave_of"), scene, demo);
    app::Demo other = app::openScene(smallScene(), 1.5);
    app::openProject(left, other);
    EXPECT_EQ(other.scene.file, scene.empty() ? "" : std::filesystem::absolute(scene).string());
    EXPECT_EQ(other.scene.name, "mine");
  }
}

TEST(Project, WhatAPersonSavesAmongWhatIsKeptIsNeitherOfferedNorForgotten) {
  const std::string folder = test::freshFolder("project_autosave_own");
  app::Demo demo = brushedDemo(5);
  const std::string left = leftBy(folder, "mine.json", demo);
  {
    app::Autosave autosave(folder);
    ASSERT_EQ(autosave.left(), left);
    autosave.replace(left);
    app::saveProject(left, demo);
    EXPECT_EQ(autosave.left(), "");
    autosave.forget(left);
  }
  app::Demo other = app::openScene(smallScene(), 1.5);
  app::openProject(left, other);
  EXPECT_EQ(other.scene.file, left);
  EXPECT_EQ(app::stateHash(other), app::stateHash(demo));
}

TEST(Project, WhatIsKeptIsNeverOlderThanWhatWasSavedSince) {
  const std::string folder = test::freshFolder("project_autosave_saved");
  app::Demo demo = brushedDemo(5);
  app::Autosave autosave(folder + "/kept");
  autosave.keep(100, demo);
  const std::string kept = folder + "/kept/autosave-" + std::to_string(getpid()) + ".json", file = folder + "/p1.json";
  for (const double now : {101.0, 102.0}) {
    goOn(5, demo);
    demo.requests = {{Ask::kSaveProject, "", file}};
    app::advanceFrame(demo, 0, {});
    autosave.keep(now, demo);
    app::Demo other = app::openScene(smallScene(), 1.5);
    app::openProject(kept, other);
    EXPECT_EQ(app::stateHash(other), app::stateHash(demo)) << "at " << now << " s";
    EXPECT_EQ(other.scene.file, file);
    EXPECT_EQ(other.scene.name, "p1");
  }
}

TEST(Project, WhatIsKeptFollowsEveryStepButNoneThatIsStillLoading) {
  const std::string folder = test::freshFolder("project_autosave_steps");
  app::Demo demo = brushedDemo(5);
  app::Autosave autosave(folder);
  double now = 100;
  const auto kept = [&] {
    autosave.keep(now += 100, demo);
    std::ifstream file(folder + "/autosave-" + std::to_string(getpid()) + ".json");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const auto ask = [&](app::Request request) {
    demo.requests.assign(1, std::move(request));
    app::advanceFrame(demo, 0, {});
  };
  kept();
  ask({Ask::kSetParam, "gravity", "3"});
  const std::string first = kept();
  EXPECT_EQ(kept(), first);
  // As many steps, and one of that name: what was undone was another.
  ask({Ask::kUndo, "", ""});
  ask({Ask::kSetParam, "density", "77"});
  ask({Ask::kUndo, "", ""});
  ask({Ask::kSetParam, "gravity", "3"});
  ask({Ask::kSetParam, "density", "78"});
  EXPECT_NE(kept().find("78"), std::string::npos);

  demo.loading.on = true;
  ask({Ask::kStyle, "bob", ""});
  ASSERT_TRUE(demo.loading.running.valid());
  EXPECT_EQ(kept().find("\"bob\""), std::string::npos);
  demo.loading.running.wait();
  app::advanceFrame(demo, 0, {});
  EXPECT_NE(kept().find("\"bob\""), std::string::npos);
}

TEST(Project, OpeningOneIsAStepThatIsUndone) {
  const std::string file = test::freshFolder("project_step") + "/mine.json";
  app::Demo demo = brushedDemo(5);
  demo.requests = {{Ask::kSaveProject, "", file}};
  app::advanceFrame(demo, 0, {});
  EXPECT_EQ(demo.scene.name, "mine");
  const std::string brushed = app::stateHash(demo);
  app::Demo other = app::openScene(smallScene(), 1.5);
  other.paused = true;
  const std::string before = app::stateHash(other), look = app::editHash(other);
  const auto ask = [&](Ask what, const std::string& text) {
    other.requests = {{what, "", text}};
    app::advanceFrame(other, 0, {});
    ASSERT_FALSE(other.message_is_fault) << other.message;
  };
  ask(Ask::kOpenProject, file);
  EXPECT_EQ(other.scene.name, "mine");
  EXPECT_EQ(app::stateHash(other), brushed);
  ask(Ask::kUndo, "");
  EXPECT_EQ(app::stateHash(other), before);
  EXPECT_EQ(app::editHash(other), look);
  ask(Ask::kRedo, "");
  EXPECT_EQ(app::stateHash(other), brushed);
}

TEST(Timeline, GoingBackAndOnWithTheSameParametersEndsInTheSameBits) {
  app::Demo demo = app::openScene(smallScene(), 1.5);
  demo.timeline.on = true;
  goOn(40, demo);
  const std::string end = app::stateHash(demo);
  ASSERT_GE(demo.timeline.frames.size(), 12u);
  app::rewindTo(20, demo);
  EXPECT_EQ(demo.frames, 20);
  EXPECT_NE(app::stateHash(demo), end);
  goOn(20, demo);
  EXPECT_EQ(app::stateHash(demo), end);
  EXPECT_THROW(app::rewindTo(1, demo), app::InputError);
  EXPECT_EQ(app::stateHash(demo), end);
  app::rewindTo(20, demo);
  demo.requests = {{Ask::kSetParam, "gravity", "3"}};
  goOn(20, demo);
  EXPECT_NE(app::stateHash(demo), end);
}

TEST(Timeline, KeepsNoMoreThanItMay) {
  app::Demo demo = app::openScene(smallScene(), 1.5);
  demo.timeline.on = true;
  goOn(12, demo);
  demo.timeline.bytes += app::kTimelineBytes;
  goOn(3, demo);
  EXPECT_EQ(demo.timeline.frames.size(), 1u);
}

}  // namespace project_test
