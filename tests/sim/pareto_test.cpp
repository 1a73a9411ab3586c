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
  double lag;    // how many times faster another way with no more error of positions may be, whatever else it is off
  const char* why;
  int reference = kCoarseReference;
};
constexpr Recorded kRecorded[] = {
    {"head_shake", 2.4e-2, 1.25, "the two levels do as well as the whole factor of this mesh, within a tenth"},
    // By the coarse reference only the first 0.4 s could be compared.
    {"walk_contact", 3.2e-3, kMostLag, "on the front", bench::kReferenceRate},
    {"walk_short", 1e-4, kMostLag, "on the front"},
    {"walk_shoulder", 5.2e-4, 1.3, "on the front, within what another processor makes of it"},
    {"jump_1x", 3.4e-3, kMostLag, "on the front"},
    {"jump_4x", 2.0e-1, 2.0,
     "positions are off by a fifth of the hair's length whatever is done, lengths and volumes not"},
    {"jump_10x", 3.1e-1, 2.0, "as at four times the speed, and all positions are off by a third of the hair's length"},
    {"collapse", 6.2e-2, 2.7, "one sample can be compared, in which any way that unfolds the hair at all is as near"},
};

void printErrors(const char* what, const bench::Errors& e) {
  std::printf("    %s: rms %.3e, most %.3e, stretch %.3e, volume %.3e, penetration %.2e m\n", what, e.rms, e.most,
              e.stretch, e.volume, e.penetration);
}

class ParetoFront : public testing::TestWithParam<Recorded> {};

TEST_P(ParetoFront, NoWayThatIsNoWorseIsFasterThanTheDefaultByMoreThanATenth) {
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
  EXPECT_LE(standard.error.rms, kMostGrowth * GetParam().error);
  for (const bench::Point& way : sweep.points) {
    const bool in_any = way.errors().noWorseInAny(standard.errors(), sweep.own_error);
    const bool in_position = way.errors().noWorseInPosition(standard.errors(), sweep.own_error);
    const double most = in_any ? kMostLag : GetParam().lag;
    if (!in_position || way.fastest * most > standard.fastest) continue;
    const double lag = bench::confirmedRatio(stage, standard.params, way.params, kRounds);
    std::printf("  %.2f times faster, error %.2e%s: %s\n", lag, way.error.rms, in_any ? ", no worse in any" : "",
                way.name().c_str());
    printErrors("default", standard.errors());
    printErrors("this way", way.errors());
    EXPECT_LE(lag, most) << way.name() << "; by positions alone: " << GetParam().why;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ParetoFront, testing::ValuesIn(kRecorded),
                         [](const auto& scene) { return std::string(scene.param.scene); });

}  // namespace
