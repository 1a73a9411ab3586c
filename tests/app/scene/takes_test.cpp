// The hairdos of assets/takes are made again by their hands alone: without a fault, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "app/files/data_path.h"
#include "app/files/recording.h"
#include "app/files/text_file.h"
#include "app/scene/demo.h"

namespace takes_test {

constexpr double kTimesRounding = 3;

struct Made {
  std::string state, fault;
  std::vector<app::ColumnEnds> ends;
  std::size_t edits = 0;
};

// `stray`: m, that vertices are moved by after every frame, to and fro, as rounding does.
Made make(const app::Recording& take, double stray = 0) {
  app::Demo demo = app::openScene(take.scene, take.aspect.value_or(1));
  demo.governor.counted = demo.deadline.counted = true;
  demo.timeline.on = true;
  Made made;
  for (const app::RecordedFrame& frame : take.frames) {
    demo.message_is_fault = false;
    demo.requests = frame.requests;
    app::advanceFrame(demo, frame.seconds, {});
    for (std::size_t v = 0; v < demo.actors[0].hair.positions.size(); ++v)
      demo.actors[0].hair.positions[v].x() += (v % 2 ? 1 : -1) * stray;
    if (demo.message_is_fault) made.fault += "frame " + std::to_string(demo.frames) + ": " + demo.message + "\n";
  }
  made.state = app::stateHash(demo);
  made.ends = app::columnEnds(demo);
  made.edits = demo.edits.steps.size();
  return made;
}

// Kernels are chosen by the processor, so the recorded end is that of its kind alone; twice on one must agree.
TEST(Takes, SixHairdosAreMadeAgainToTheBitAndEndWhereTheyWereRecorded) {
  std::vector<std::string> files = app::listAssets("takes", {".take"});
  ASSERT_EQ(files.size(), 6u);
  int recorded = 0, steadies = 0;
  for (const std::string& file : files) {
    const app::Recording take = app::readRecording(app::readText(file), file);
    const Made once = make(take);
    EXPECT_EQ(once.fault, "") << file;
    EXPECT_GE(once.edits, 2u) << file;
    // Those who recorded it made it once already.
    if (once.state == take.state)
      ++recorded;
    else
      EXPECT_EQ(once.state, make(take).state) << file;
    // Whatever the processor, no farther than rounding alone carries it.
    const auto apart = app::apartOf(take.ends, once.ends), rounded = app::apartOf(once.ends, make(take, 1e-12).ends);
    ASSERT_TRUE(apart && rounded) << file;
    EXPECT_LT(apart->mean, app::kMaxApart + kTimesRounding * rounded->mean) << file;
    steadies += rounded->mean < app::kMaxApart;
    EXPECT_EQ(take.edited, false) << file;
    std::printf("in the mean %.6f mm from the recorded ends, %.6f mm after a stray of 1e-12 m: ", 1e3 * apart->mean,
                1e3 * rounded->mean);
    std::printf("%s: %zu frames, %.1f s\n", app::stem(file).c_str(), take.frames.size(),
                static_cast<double>(take.frames.size()) / 60);
  }
  EXPECT_GE(steadies, 3);
  if (recorded != 6) std::printf("%d of 6 end as on the processor that recorded them\n", recorded);
}

}  // namespace takes_test
