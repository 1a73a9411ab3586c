// The default's place among the ways to simulate: a short version of the sweep behind docs/accuracy.md. Times are
// compared within one run only.
#include <gtest/gtest.h>

#include "tests/bench/sweep.h"

namespace {

constexpr int kCoarseReference = 1920;  // steps a second: errors of the sweep are above its own
constexpr double kMostLag = 1.10;       // at equal error, on the front
constexpr double kMostGrowth = 1.10;    // of an error over its recorded figure: rounding differs between machines
constexpr int kRounds = 5;              // of runs in turns, where a first look suspects a lag

// What is known of the default's place in a scene: more than this is a regression.
struct Recorded {
  const char* scene;
  double error;  // RMS over hair length, of the default, over the samples that can be compared
  double lag;    // how many times faster another way with no more error may be
  const char* why;
  int reference = kCoarseReference;
};
constexpr Recorded kRecorded[] = {
    {"head_shake", 2.5e-2, 1.25, "the two levels do as well as the whole factor of this mesh, within a tenth"},
    // By the coarse reference only the first 0.4 s could be compared.
    {"walk_contact", 3.6e-3, kMostLag, "on the front", bench::kReferenceRate},
    {"walk_short", 1.4e-4, kMostLag, "on the front"},
    {"walk_shoulder", 7e-4, 1.3, "on the front, within what another processor makes of it"},
    {"jump_1x", 3.1e-3, kMostLag, "on the front"},
    {"jump_4x", 2.0e-1, 2.0, "no way comes nearer than a sixth of the hair's length, and looser solves are as near"},
    {"jump_10x", 3.1e-1, 2.0, "as at four times the speed, and all errors are a third of the hair's length"},
    {"collapse", 6.0e-2, 2.7, "one sample can be compared, in which any way that unfolds the hair at all is as good"},
};

class ParetoFront : public testing::TestWithParam<Recorded> {};

TEST_P(ParetoFront, NoWayWithAnEqualErrorIsFasterThanTheDefaultByMoreThanIsRecorded) {
  const auto scenes = bench::trajectoryScenes();
  const auto scene =
      std::find_if(scenes.begin(), scenes.end(), [](const auto& s) { return s.name == std::string(GetParam().scene); });
  ASSERT_NE(scene, scenes.end());
  bench::TrajectoryStage stage(*scene);
  const bench::Reference reference = bench::referenceOf(stage, GetParam().reference, "");
  const auto ways = bench::waysToRun(bench::SweepSize::kShort, scene->collide);
  const bench::Sweep sweep = bench::sweepScene(stage, reference, ways, 2);
  const bench::Point& standard = sweep.points.front();
  std::printf("%s: default %.1f ms/s, error %.2e; reference's own %.1e over %.2f s\n", scene->name, standard.fastest,
              standard.error.rms, sweep.own_error, sweep.compared_seconds);
  const bench::Lag first = bench::lagOfDefault(sweep);
  std::printf("  at first sight %.2f times faster: %s\n", first.ratio, first.way->name().c_str());
  EXPECT_LE(standard.error.rms, kMostGrowth * GetParam().error);
  for (const bench::Point& way : sweep.points) {
    const bool no_worse = way.error.rms <= standard.error.rms + sweep.own_error;
    if (!no_worse || way.fastest * GetParam().lag > standard.fastest) continue;
    const double lag = bench::confirmedRatio(stage, standard.params, way.params, kRounds);
    std::printf("  %.2f times faster, error %.2e: %s\n", lag, way.error.rms, way.name().c_str());
    EXPECT_LE(lag, GetParam().lag) << way.name() << "; recorded: " << GetParam().why;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ParetoFront, testing::ValuesIn(kRecorded),
                         [](const auto& scene) { return std::string(scene.param.scene); });

}  // namespace
