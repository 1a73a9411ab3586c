// A cache of simulated hair: any frame is shown at once as it was, its key frames go on to the bit, and what is not it
// is refused.
#include "app/scene/record/sim_cache.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/platform/hair_recorder.h"
#include "app/scene/demo_state.h"
#include "app/scene/edit/groom_brush.h"
#include "tests/run_program.h"

namespace sim_cache_test {

constexpr int kFrames = 70;
constexpr double kFrame = 1.0 / 60;

app::Scene sceneOf(app::Style style) {
  app::Scene scene;
  scene.characters.emplace_back();
  scene.characters[0].motion = app::dataPath("assets/clips/walk.bvh");
  scene.characters[0].style = style;
  scene.characters[0].resolution = app::Resolution::kLow;
  scene.playback.settle = 0.1;
  return scene;
}

app::Demo opened(app::Style style = app::Style::kShort) {
  app::Demo demo = app::openScene(sceneOf(style), 1.5);
  demo.governor.counted = demo.deadline.counted = true;
  return demo;
}

// What a frame showed, in the world.
std::vector<app::Vec3> shownOf(const app::Demo& demo) {
  std::vector<app::Vec3> shown;
  const std::vector<float>& at = demo.actors[0].shown_positions;
  for (std::size_t v = 0; 3 * v + 2 < at.size(); ++v)
    shown.push_back(app::Vec3(at[3 * v], at[3 * v + 1], at[3 * v + 2]) + demo.origin);
  for (const app::Rigid& joint : demo.actors[0].shown_pose.world) shown.push_back(joint.translation());
  return shown;
}

struct Cached {
  std::string file;
  std::vector<std::vector<app::Vec3>> shown;  // per frame, from frame 1 on
  std::vector<std::string> states;
};

const Cached& cached() {
  static const Cached once = [] {
    Cached out;
    out.file = test::freshFolder("sim_cache") + "/walk.hairmesh";
    app::Demo demo = opened();
    app::SimCacheWriter writer(out.file, demo);
    for (int frame = 0; frame < kFrames; ++frame) {
      app::advanceFrame(demo, kFrame, {});
      writer.add(demo);
      out.shown.push_back(shownOf(demo));
      out.states.push_back(app::demoStateBytes(demo));
    }
    EXPECT_NE(writer.finish(demo).find("70 frames cached"), std::string::npos);
    return out;
  }();
  return once;
}

double farthest(const std::vector<app::Vec3>& a, const std::vector<app::Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double far = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    far = std::max(far, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return far;
}

TEST(SimCache, ShowsAnyFrameToAndFroWithinHalfAStep) {
  app::Demo demo = opened();
  demo.paused = true;
  app::openCache(cached().file, demo);
  ASSERT_TRUE(demo.timeline.cache);
  EXPECT_EQ(demo.timeline.cache->first(), 1);
  EXPECT_EQ(demo.timeline.cache->last(), kFrames);
  for (const int frame : {70, 1, 44, 43, 60, 31, 30, 29, 12}) {
    demo.requests.push_back({app::Ask::kRewind, "", "", static_cast<double>(frame)});
    app::advanceFrame(demo, kFrame, {});
    EXPECT_EQ(demo.stats.steps, 0);
    EXPECT_LE(farthest(shownOf(demo), cached().shown[static_cast<std::size_t>(frame - 1)]),
              0.5 * app::kCacheStep + 2e-6)
        << "frame " << frame;
  }
}

TEST(SimCache, GoesOnToTheBitFromKeyFrames) {
  app::Demo demo = opened();
  app::SimCache cache(cached().file, demo);
  for (const auto& [asked, key] : {std::pair(1, 1), {40, 31}, {31, 31}, {69, 61}, {70, 70}}) {
    cache.resume(asked, false, demo);
    EXPECT_EQ(demo.frames, key);
    EXPECT_TRUE(app::demoStateBytes(demo) == cached().states[static_cast<std::size_t>(key - 1)]) << asked;
    for (int frame = key; frame < std::min(key + 8, kFrames); ++frame) {
      app::advanceFrame(demo, kFrame, {});
      ASSERT_TRUE(app::demoStateBytes(demo) == cached().states[static_cast<std::size_t>(frame)]) << frame;
    }
  }
}

TEST(SimCache, TheTimelineGoesOnFromTheKeyFrameBeforeWhatItShows) {
  app::Demo demo = opened();
  app::openCache(cached().file, demo);
  demo.requests.push_back({app::Ask::kPause, "", "", 1});
  demo.requests.push_back({app::Ask::kRewind, "", "", 40});
  app::advanceFrame(demo, kFrame, {});
  EXPECT_EQ(demo.timeline.shown_of_cache, 40);
  demo.requests.push_back({app::Ask::kPause, "", "", 0});
  app::advanceFrame(demo, kFrame, {});
  EXPECT_EQ(demo.timeline.shown_of_cache, -1);
  EXPECT_TRUE(app::demoStateBytes(demo) == cached().states[31]) << "frame 32 follows the whole state of frame 31";
}

TEST(SimCache, IsSmallBesideTheStates) {
  double states = 0;
  for (const std::string& state : cached().states) states += static_cast<double>(state.size());
  EXPECT_LT(static_cast<double>(std::filesystem::file_size(cached().file)), 0.25 * states);
}

std::string faultOf(const std::string& file, app::Demo& demo) {
  const std::string before = app::demoStateBytes(demo);
  try {
    app::SimCache(file, demo).show(40, demo);
  } catch (const app::InputError& fault) {
    EXPECT_TRUE(app::demoStateBytes(demo) == before) << "half of it was loaded";
    return fault.what();
  }
  return "";
}

TEST(SimCache, RefusesOtherHairAndWhatWasChanged) {
  const std::string whole = test::readAll(cached().file);
  const std::string file = test::freshFolder("sim_cache_bad") + "/bad.hairmesh";
  app::Demo demo = opened(), other = opened(app::Style::kLong);
  const auto written = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return faultOf(file, demo);
  };
  EXPECT_EQ(written(whole), "");
  EXPECT_NE(faultOf(cached().file, other).find("is of other hair"), std::string::npos);
  EXPECT_NE(written("hairmesh-cache 9\n" + whole.substr(17)).find("another version"), std::string::npos);
  EXPECT_NE(written("hello").find("no cache"), std::string::npos);
  EXPECT_NE(written(whole.substr(0, whole.size() / 2)).find("cut off"), std::string::npos);
  EXPECT_NE(written(whole.substr(0, 30)).find("cut off"), std::string::npos);
  std::string unfinished = whole;
  for (std::size_t k = 17; k < 33; ++k) unfinished[k] = 0;
  EXPECT_NE(written(unfinished).find("never finished"), std::string::npos);
  // A changed byte anywhere is named, but in frames that are not asked for.
  for (std::size_t at = 40; at < whole.size(); at += whole.size() / 60) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    const std::string fault = written(changed);
    EXPECT_TRUE(fault.empty() || fault.find("bad.hairmesh") != std::string::npos) << fault;
    EXPECT_TRUE(fault.empty() || fault.find("; ") != std::string::npos) << fault;
  }
  std::string index = whole;
  index[whole.size() - 20] = static_cast<char>(index[whole.size() - 20] ^ 1);
  EXPECT_NE(written(index).find("changed"), std::string::npos);
}

TEST(SimCache, IsWrittenHeadlessAndGoneOnFrom) {
  const std::string folder = test::freshFolder("sim_cache_run"), file = folder + "/run.hairmesh";
  const std::vector<std::string> scene{"--no-images", "--motion",     "walk.bvh", "--style",
                                       "short",       "--resolution", "low"};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), scene.begin(), scene.end());
    return test::runProgram(more);
  };
  const test::Outcome outcome = run({"--frames", "20", "--cache", file, "--save-state", folder + "/20.state"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("20 frames cached in"), std::string::npos) << outcome.out;
  for (const std::string& from : {file, folder + "/20.state"})
    EXPECT_EQ(run({"--frames", "5", "--load-state", from, "--save-state", from + ".after"}).exit_code, 0);
  EXPECT_TRUE(test::readAll(file + ".after") == test::readAll(folder + "/20.state.after"));
  EXPECT_EQ(run({"--frames", "5", "--cache", folder + "/run.abc"}).exit_code, app::kExitUsage);
  const test::Outcome other = test::runProgram({"--no-images", "--motion", "walk.bvh", "--style", "long",
                                                "--resolution", "low", "--frames", "1", "--load-state", file});
  EXPECT_EQ(other.exit_code, app::kExitBadInput);
  EXPECT_NE(other.err.find("is of other hair"), std::string::npos) << other.err;
}

TEST(SimCache, LeavesNothingOnAFullDisk) {
  const std::string folder = test::freshFolder("sim_cache_full"), file = folder + "/run.hairmesh";
  const test::Outcome outcome = test::runProgram({"--no-images", "--motion", "walk.bvh", "--style", "short",
                                                  "--resolution", "low", "--frames", "60", "--cache", file},
                                                 "sh -c 'ulimit -f 200; trap \"\" XFSZ; exec \"$@\"' sh");
  EXPECT_EQ(outcome.exit_code, app::kExitFault) << outcome.err;
  EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

void recordFrames(int count, app::HairRecorder& recorder, app::Demo& demo) {
  for (int frame = 0; frame < count; ++frame) {
    app::advanceFrame(demo, kFrame, {});
    recorder.frame(demo);
  }
}

TEST(HairRecorder, WritesACacheThatTheTimelineThenShowsAndAnExport) {
  const std::string folder = test::freshFolder("hair_recorder");
  app::Demo demo = opened();
  app::HairRecorder recorder(60);
  for (const char* name : {"/a.hairmesh", "/b.abc", "/c.glb"}) {
    demo.requests.push_back({app::Ask::kRecordHair, "", folder + name, 1});
    recordFrames(12, recorder, demo);
    EXPECT_FALSE(demo.message_is_fault) << demo.message;
    demo.requests.push_back({app::Ask::kRecordHair, "", "", 0});
    recordFrames(1, recorder, demo);
    EXPECT_FALSE(demo.message_is_fault) << demo.message;
    EXPECT_GT(std::filesystem::file_size(folder + name), 1000u);
  }
  ASSERT_TRUE(demo.timeline.cache);
  EXPECT_EQ(demo.timeline.cache->last() - demo.timeline.cache->first(), 11);
  demo.requests.push_back({app::Ask::kRecordHair, "", folder + "/none/a.hairmesh", 1});
  recordFrames(2, recorder, demo);
  EXPECT_TRUE(demo.message_is_fault);
  EXPECT_FALSE(demo.capture.hair);
}

// An edit of the rest shape leaves a cache to look at, and to go on from.
TEST(SimCache, ShowsItsFramesAfterAnEdit) {
  app::Demo demo = opened();
  demo.paused = true;
  app::openCache(cached().file, demo);
  std::vector<app::Vec3> shape = demo.actors[0].haircut->mesh.shape.positions;
  shape.back().y() -= 0.002;
  app::reshapeHair(shape, 0, demo);
  ASSERT_TRUE(demo.timeline.cache);
  for (const int frame : {44, 12}) {
    demo.requests.push_back({app::Ask::kRewind, "", "", static_cast<double>(frame)});
    app::advanceFrame(demo, kFrame, {});
    EXPECT_FALSE(demo.message_is_fault) << demo.message;
    EXPECT_LE(farthest(shownOf(demo), cached().shown[static_cast<std::size_t>(frame - 1)]),
              0.5 * app::kCacheStep + 2e-6);
  }
  demo.paused = false;
  app::advanceFrame(demo, kFrame, {});
  EXPECT_FALSE(demo.message_is_fault) << demo.message;
  EXPECT_EQ(demo.actors[0].haircut->mesh.shape.positions, shape);
}

TEST(HairRecorder, NumbersFramesByTheTimeOfTheRun) {
  const std::string folder = test::freshFolder("hair_recorder_numbers");
  app::Demo demo = opened();
  app::HairRecorder recorder(60);
  recordFrames(10, recorder, demo);
  demo.requests.push_back({app::Ask::kRecordHair, "", folder + "/a.ply", 1});
  recordFrames(2, recorder, demo);
  demo.requests.push_back({app::Ask::kRecordHair, "", "", 0});
  recordFrames(1, recorder, demo);
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  EXPECT_EQ(names, (std::set<std::string>{"a_0011.ply", "a_0012.ply"}));
}

}  // namespace sim_cache_test
