// Time steps, the governor's rungs, paces, playback speeds, scrubbing, styles and the endurance runs.
#include <array>
#include <cmath>

#include "app/scene/detail/governor.h"
#include "sim/field_text.h"
#include "tests/stress/matrix.h"
#include "tests/stress/stage.h"

namespace stress {

std::span<const char* const> ownClips() {
  static constexpr std::array<const char*, 5> kClips{"walk.bvh", "dance.bvh", "head_shake.bvh", "jump_spin.bvh",
                                                     "idle_turns.bvh"};
  return kClips;
}

std::span<const char* const> capturedClips() {
  static constexpr std::array<const char*, 6> kClips{"cmu_02_01_walk.bvh",     "cmu_02_03_run.bvh",
                                                     "cmu_02_04_jump.bvh",     "cmu_salsa17_spins_clean.bvh",
                                                     "deepmimic_backflip.bvh", "deepmimic_cartwheel.bvh"};
  return kClips;
}

std::span<const char* const> allCaptures() {
  static constexpr std::array<const char*, 10> kClips{"cmu_02_01_walk.bvh",
                                                      "cmu_02_03_run.bvh",
                                                      "cmu_02_04_jump.bvh",
                                                      "cmu_indian_15_dance.bvh",
                                                      "cmu_salsa17_spins_clean.bvh",
                                                      "deepmimic_backflip.bvh",
                                                      "deepmimic_cartwheel.bvh",
                                                      "rokoko_dance.bvh",
                                                      "dance.mot",
                                                      "dance-paused.mot"};
  return kClips;
}

std::span<const HairChoice> lowStyles() {
  static constexpr std::array<HairChoice, 3> kStyles{
      HairChoice{Cut::kStyle, app::Style::kShort, app::Resolution::kLow},
      HairChoice{Cut::kStyle, app::Style::kShoulder, app::Resolution::kLow},
      HairChoice{Cut::kStyle, app::Style::kLong, app::Resolution::kLow}};
  return kStyles;
}

std::string stepName(double step) {
  return "1-" + sim::numberText(std::round(1 / step)) + "s";
}

std::string plain(double value) {
  return sim::numberText(value);
}

namespace {

std::string clipName(const char* clip) {
  const std::string name = clip;
  return name.substr(0, name.find('.'));
}

// What the bounds on a step's counts add up to.
constexpr double kMaxStepWork = 170;

constexpr std::array<double, 9> kSteps{1.0 / 1000, 1.0 / 480, 1.0 / 240, 1.0 / 120, 1.0 / 60,
                                       1.0 / 30,   1.0 / 20,  1.0 / 15,  0.1};

}  // namespace

void addSteps(Cases& cases) {
  for (const double step : kSteps) {
    for (const char* clip : ownClips()) {
      for (const HairChoice& hair : lowStyles()) {
        StressCase one;
        one.name = "step/" + stepName(step) + "/" + clipName(clip) + "/" + hairName(hair);
        one.hair = hair;
        one.clip = clip;
        one.play = Play::kForward;
        one.step = step;
        one.in_short = hair.style != app::Style::kShoulder && clipName(clip) == "dance";
        // Left bent over a shoulder: when the body is taken away, it springs back for many steps.
        one.in_short |= hair.style == app::Style::kLong && clipName(clip) == "jump_spin" && step == 1.0 / 120;
        cases.push_back(one);
      }
    }
  }
}

// The settings that the budget governor may choose by itself, as app::governed puts them in place.
void addLadder(Cases& cases) {
  for (const app::Rung& rung : app::ladder()) {
    const double step = 1 / rung.steps_per_second;
    const std::string name =
        std::string(sim::findParam("integrator")->choices[static_cast<int>(rung.integrator)]) + "-" + stepName(step);
    for (const HairChoice& hair : lowStyles()) {
      StressCase dance;
      dance.name = "ladder/" + name + "/dance/" + hairName(hair);
      dance.hair = hair;
      dance.clip = "dance.bvh";
      dance.play = Play::kForward;
      dance.step = step;
      dance.params = {{"integrator", static_cast<double>(rung.integrator)},
                      {"tolerance", rung.tolerance},
                      {"max_iterations", rung.max_iterations}};
      dance.in_short = hair.style == app::Style::kLong;
      StressCase turn = dance;
      turn.name = "ladder/" + name + "/turn/" + hairName(hair);
      turn.clip = "idle_turns.bvh";
      turn.play = Play::kStill;
      turn.upset = Upset::kTurn;
      cases.push_back(dance);
      cases.push_back(turn);
    }
  }
}

void addPaces(Cases& cases) {
  for (const Pace pace : {Pace::kRandomSteps, Pace::kRandomFrames}) {
    for (const char* clip : ownClips()) {
      for (const HairChoice& hair : lowStyles()) {
        for (int draw = 0; draw < 10; ++draw) {
          StressCase one;
          one.name = std::string("pace/") + (pace == Pace::kRandomSteps ? "steps" : "frames") + "/" + clipName(clip) +
                     "/" + hairName(hair) + "/" + std::to_string(draw);
          one.hair = hair;
          one.clip = clip;
          one.play = Play::kForward;
          one.pace = pace;
          one.seconds = 4;
          one.in_short = draw == 0 && hair.style == app::Style::kLong;
          cases.push_back(one);
        }
      }
    }
  }
}

void addSpeeds(Cases& cases) {
  const auto add = [&](const char* clip, bool own) {
    for (const double speed : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
      for (const HairChoice& hair : lowStyles()) {
        StressCase one;
        one.name = "speed/" + plain(speed) + "x/" + clipName(clip) + "/" + hairName(hair);
        one.hair = hair;
        one.clip = clip;
        one.play = Play::kForward;
        one.speed = speed;
        one.seconds = 2;
        // A spin at twenty times comes back or not as rounding has it: wind of 0.1 mm/s makes it stay away.
        const bool chance = speed == 20 && clipName(clip) == "jump_spin";
        one.in_short = own && hair.style == app::Style::kLong && clipName(clip) != "idle_turns" && !chance;
        cases.push_back(one);
      }
    }
  };
  for (const char* clip : ownClips()) add(clip, true);
  for (const char* clip : capturedClips()) add(clip, false);
}

// Whole clips with the seams of their loops.
void addCaptures(Cases& cases) {
  for (const char* clip : allCaptures()) {
    for (const char* loop : {"go-on", "in-place"}) {
      for (const double speed : {1.0, 4.0, 10.0, 20.0}) {
        for (const HairChoice& hair : lowStyles()) {
          StressCase one;
          one.name = "capture/" + clipName(clip) + "/" + loop + "/" + plain(speed) + "x/" + hairName(hair);
          one.hair = hair;
          one.clip = clip;
          one.play = Play::kForward;
          one.speed = speed;
          one.rounds = 2;
          one.loop = loop;
          one.max_work = kMaxStepWork;
          one.by_forces = speed == 1;
          one.sees_skin = true;
          one.grace = 0.1;  // after the jump of a figure that stays in place
          cases.push_back(one);
        }
      }
    }
  }
}

void addScrubs(Cases& cases) {
  const auto add = [&](const char* clip, Play play, double speed, const std::string& what) {
    for (const HairChoice& hair : lowStyles()) {
      StressCase one;
      one.name = "scrub/" + what + "/" + clipName(clip) + "/" + hairName(hair);
      one.hair = hair;
      one.clip = clip;
      one.play = play;
      one.speed = speed;
      one.seconds = 1.5;
      one.grace = play == Play::kCarryJumps ? 0.1 : 0;
      one.in_short = clipName(clip) == "dance";
      cases.push_back(one);
    }
  };
  for (const auto& clips : {ownClips(), capturedClips()}) {
    for (const char* clip : clips) {
      for (const double speed : {1.0, 5.0, 20.0}) add(clip, Play::kBackward, speed, "back-" + plain(speed) + "x");
      add(clip, Play::kJumps, 1, "jumps");
      add(clip, Play::kCarryJumps, 1, "carried-jumps");
    }
  }
}

void addStyles(Cases& cases) {
  std::vector<HairChoice> choices;
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    for (const auto resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh})
      choices.push_back({Cut::kStyle, style, resolution});
    for (const Cut cut : {Cut::kUneven, Cut::kSingleBundle}) choices.push_back({cut, style, app::Resolution::kLow});
  }
  choices.push_back({Cut::kTenThousand, app::Style::kLong, app::Resolution::kHigh});
  for (const HairChoice& hair : choices) {
    const bool small = hair.resolution == app::Resolution::kLow;
    for (const char* clip : {"dance.bvh", "jump_spin.bvh"}) {
      StressCase one;
      one.name = "style/" + hairName(hair) + "/" + clipName(clip);
      one.hair = hair;
      one.clip = clip;
      one.play = Play::kForward;
      one.in_short = small;
      cases.push_back(one);
    }
    StressCase one;
    one.name = "style/" + hairName(hair) + "/collapsed";
    one.hair = hair;
    one.start = Start::kCollapsed;
    one.grace = 0.1;
    one.seconds = 0.1;
    one.in_short = small;
    cases.push_back(one);
  }
}

void addEndurance(Cases& cases) {
  for (const char* clip : {"dance.bvh", "walk.bvh"}) {
    StressCase one;
    one.name = std::string("endurance/hour/") + clipName(clip);
    one.clip = clip;
    one.play = Play::kForward;
    one.seconds = 3600;
    one.endurance = true;
    cases.push_back(one);
  }
  StressCase brief;
  brief.name = "endurance/twenty-seconds/dance";
  brief.clip = "dance.bvh";
  brief.play = Play::kForward;
  brief.seconds = 20;
  brief.in_short = true;
  brief.endurance = true;
  cases.push_back(brief);
}

}  // namespace stress
