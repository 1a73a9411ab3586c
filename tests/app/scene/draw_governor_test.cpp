// The drawing governor against machines that it does not know, by a clock that is fed in: budgets are held, nothing
// swings, detail comes back, settings glide, and bad values are refused.
#include "app/scene/detail/draw_governor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/test_meshes.h"

namespace draw_governor_test {

using app::DrawGovernor;
using app::drawLadder;

// What the frame at full detail takes on a machine, s; each rung's share of that is off the ladder's word by up to
// `spread`, each frame by up to `noise`.
struct Machine {
  double full = 0.02, spread = 0.2, noise = 0.08, fps = 60;
  std::uint64_t seed = 1;
};

struct Held {
  std::vector<int> rungs;  // every frame
  std::vector<double> places, costs;
  DrawGovernor governor;
};

template <class Load>
Held hold(double budget, double seconds, const Machine& machine, const Load& loadAt) {
  test::Random random(machine.seed);
  std::vector<double> cost;
  for (const app::DrawRung& rung : drawLadder()) {
    cost.push_back(machine.full * rung.cost * (1 + random(-machine.spread, machine.spread)));
    if (cost.size() > 1) cost.back() = std::min(cost.back(), 0.96 * cost[cost.size() - 2]);
  }
  Held held;
  app::setDrawBudget(budget, held.governor);
  const int frames = static_cast<int>(seconds * machine.fps);
  for (int f = 0; f < frames; ++f) {
    app::glide(1 / machine.fps, held.governor);
    const double place = held.governor.place;
    const auto from = static_cast<std::size_t>(place);
    const std::size_t to = std::min(from + 1, cost.size() - 1);
    double took = cost[from] + (place - static_cast<double>(from)) * (cost[to] - cost[from]);
    took *= loadAt(f / machine.fps) * (1 + random(-machine.noise, machine.noise));
    if (f == 0) took += 1;  // shaders are compiled
    held.rungs.push_back(held.governor.rung);
    held.places.push_back(place);
    held.costs.push_back(took);
    app::observeDrawing(1 / machine.fps, took, held.governor);
  }
  return held;
}

Held hold(double budget, double seconds, const Machine& machine) {
  return hold(budget, seconds, machine, [](double) { return 1.0; });
}

double medianFrom(const std::vector<double>& costs, std::size_t from) {
  std::vector<double> some(costs.begin() + static_cast<std::ptrdiff_t>(from), costs.end());
  std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2), some.end());
  return some[some.size() / 2];
}

int changesFrom(const std::vector<int>& rungs, std::size_t from) {
  int count = 0;
  for (std::size_t k = std::max<std::size_t>(from, 1); k < rungs.size(); ++k) count += rungs[k] != rungs[k - 1];
  return count;
}

TEST(DrawLadder, CostsFallAndErrorsRiseFromFullDetail) {
  EXPECT_EQ(drawLadder()[0].strands, 1);
  EXPECT_EQ(drawLadder()[0].cost, 1);
  for (std::size_t k = 1; k < drawLadder().size(); ++k) {
    EXPECT_LT(drawLadder()[k].cost, drawLadder()[k - 1].cost) << drawLadder()[k].name;
    EXPECT_GT(drawLadder()[k].error, drawLadder()[k - 1].error) << drawLadder()[k].name;
    EXPECT_LT(drawLadder()[k].strands, drawLadder()[k - 1].strands) << drawLadder()[k].name;
  }
}

TEST(DrawGovernor, BudgetsAreHeldOnMachinesThatItDoesNotKnow) {
  const double cheapest = drawLadder().back().cost;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    for (const double share : {1.3 * cheapest, 0.5, 0.65, 0.8, 1.0, 1.3, 3.0}) {
      Machine machine;
      machine.seed = seed;
      const double budget = share * machine.full;
      const Held held = hold(budget, 20, machine);
      EXPECT_LE(medianFrom(held.costs, 10 * 60), 1.05 * budget) << "share " << share << " seed " << seed;
      EXPECT_FALSE(held.governor.over_budget);
    }
  }
}

TEST(DrawGovernor, TheFirstFramesAndAFreeMachineCostNoDetail) {
  const Held held = hold(0.03, 10, {});
  EXPECT_EQ(held.governor.changes, 0);
  EXPECT_EQ(held.governor.rung, 0);
}

TEST(DrawGovernor, SaysThatTheCheapestRungTakesLonger) {
  const Held held = hold(0.3 * drawLadder().back().cost * 0.02, 20, {});
  EXPECT_EQ(held.rungs.back(), static_cast<int>(drawLadder().size()) - 1);
  EXPECT_TRUE(held.governor.over_budget);
}

TEST(DrawGovernor, NothingSwings) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    for (const double share : {0.4, 0.55, 0.7, 0.85, 1.0, 1.15}) {
      Machine machine;
      machine.seed = seed;
      const Held held = hold(share * machine.full, 120, machine);
      EXPECT_LE(changesFrom(held.rungs, 30 * 60), 6) << "share " << share << " seed " << seed;
    }
  }
}

TEST(DrawGovernor, DetailComesBackWhenTheLoadIsGone) {
  const double budget = 0.024;
  const Held held = hold(budget, 60, {}, [](double t) { return t > 10 && t < 20 ? 2.5 : 1.0; });
  EXPECT_EQ(held.rungs[9 * 60], 0);
  EXPECT_GE(held.rungs[19 * 60], 2);
  EXPECT_EQ(held.rungs.back(), 0);
}

// However far it goes, a frame takes a small part of the way.
TEST(DrawGovernor, GlidesFromRungToRung) {
  for (const double fps : {144.0, 60.0, 2.0}) {
    Machine machine;
    machine.fps = fps;
    const Held held = hold(0.4 * machine.full, 600 / fps + 10, machine);
    EXPECT_GE(held.governor.changes, 1);
    for (std::size_t k = 1; k < held.places.size(); ++k) {
      const double way = std::max(1.0, std::ceil(std::abs(held.rungs[k] - held.places[k - 1])));
      EXPECT_LE(std::abs(held.places[k] - held.places[k - 1]), way * std::min(2 / fps, 0.25) + 1e-9) << fps;
    }
  }
}

// Nobody waits for one rung after another: neither where drawing takes many times the budget from the start on, nor
// after the load of a start that has gone.
TEST(DrawGovernor, IsWhereItBelongsSoonAfterAStart) {
  Machine machine;
  machine.fps = 2, machine.full = 0.5;
  const Held slow = hold(0.4 * machine.full, 10, machine);
  EXPECT_LE(slow.costs.back(), 1.2 * 0.4 * machine.full) << "20 frames";
  const Held loaded = hold(0.03, 6, {}, [](double t) { return t < 2 ? 4.0 : 1.0; });
  EXPECT_GE(loaded.rungs[90], 4);
  EXPECT_EQ(loaded.rungs[5 * 60], 0);
}

TEST(DrawGovernor, ChangesNothingWhenOffAndAtFullDetail) {
  render::FrameInput frame;
  frame.view.segment_error = 0.3f;
  const render::ViewOptions view = frame.view;
  const render::LightInput light = frame.light;
  DrawGovernor governor;
  governor.rung = 3, governor.place = 3;
  app::governDrawing(governor, frame);
  EXPECT_EQ(frame.view, view);
  app::setDrawBudget(1, governor);
  EXPECT_EQ(governor.rung, 0) << "begins at full detail";
  app::governDrawing(governor, frame);
  EXPECT_EQ(frame.view, view);
  EXPECT_EQ(frame.light, light);
  governor.place = 1.5;
  app::governDrawing(governor, frame);
  EXPECT_LT(frame.view.strand_share, drawLadder()[1].strands);
  EXPECT_GT(frame.view.strand_share, drawLadder()[2].strands);
  EXPECT_LT(frame.light.shadow_strand_share, 1);
  EXPECT_GT(frame.view.segment_error, 0.3f);
}

TEST(DrawGovernor, BadBudgetsAndTimesAreRefused) {
  DrawGovernor governor;
  for (const double bad : {std::nan(""), -1.0, HUGE_VAL}) {
    app::setDrawBudget(bad, governor);
    EXPECT_EQ(governor.budget, 0) << bad;
  }
  app::setDrawBudget(0.01, governor);
  for (int frame = 0; frame < 100; ++frame) app::observeDrawing(1.0 / 60, std::nan(""), governor);
  EXPECT_EQ(governor.changes, 0);
  EXPECT_EQ(governor.frames, 0);
}

}  // namespace draw_governor_test
