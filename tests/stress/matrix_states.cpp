// Impossible states, violent motion, bodies in the way, faults.
#include <array>

#include "tests/stress/matrix.h"
#include "tests/stress/stage.h"

namespace stress {
namespace {

struct StartRow {
  const char* name;
  Start start;
  double size;
};
constexpr std::array<StartRow, 13> kStarts{{{"collapsed", Start::kCollapsed, 0},
                                            {"flattened", Start::kFlattened, 0},
                                            {"inverted", Start::kInverted, 0},
                                            {"inside-out", Start::kInsideOut, 0},
                                            {"shuffled", Start::kShuffled, 0},
                                            {"noise-1cm", Start::kNoise, 0.01},
                                            {"noise-5cm", Start::kNoise, 0.05},
                                            {"noise-20cm", Start::kNoise, 0.2},
                                            {"fast-1", Start::kFast, 1},
                                            {"fast-10", Start::kFast, 10},
                                            {"fast-100", Start::kFast, 100},
                                            {"stretched-2", Start::kStretched, 2},
                                            {"squeezed-0.1", Start::kStretched, 0.1}}};

struct UpsetRow {
  const char* name;
  Upset upset;
  double size;
  double grace;  // s
};
constexpr std::array<UpsetRow, 23> kUpsets{{{"turn-180", Upset::kTurn, 0, 0},
                                            {"teleport-0.1m", Upset::kTeleport, 0.1, 0},
                                            {"teleport-1m", Upset::kTeleport, 1, 0},
                                            {"teleport-10m", Upset::kTeleport, 10, 0},
                                            {"teleport-1000m", Upset::kTeleport, 1000, 0},
                                            {"spin-10", Upset::kSpin, 10, 0},
                                            {"spin-50", Upset::kSpin, 50, 0},
                                            {"spin-200", Upset::kSpin, 200, 0},
                                            {"shake-1hz", Upset::kShake, 1, 0},
                                            {"shake-5hz", Upset::kShake, 5, 0},
                                            {"shake-20hz", Upset::kShake, 20, 0},
                                            {"nod-1hz", Upset::kNod, 1, 0},
                                            {"nod-5hz", Upset::kNod, 5, 0},
                                            {"nod-20hz", Upset::kNod, 20, 0},
                                            {"body-rise-5cm", Upset::kBodyRise, 0.05, 0},
                                            {"body-rise-15cm", Upset::kBodyRise, 0.15, 0},
                                            {"arm-1", Upset::kArm, 1, 0},
                                            {"arm-5", Upset::kArm, 5, 0},
                                            {"arm-20", Upset::kArm, 20, 0},
                                            {"arm-100", Upset::kArm, 100, 0},
                                            {"switch-on-5cm", Upset::kSwitchOn, 0.05, 0.1},
                                            {"switch-on-12cm", Upset::kSwitchOn, 0.12, 0.1},
                                            {"buried-roots", Upset::kBury, 0, 0.1}}};

bool addsBody(Upset upset) {
  return upset == Upset::kArm || upset == Upset::kSwitchOn || upset == Upset::kBury;
}

}  // namespace

void addStates(Cases& cases) {
  for (const StartRow& row : kStarts) {
    for (const HairChoice& hair : lowStyles()) {
      for (const double step : {1.0 / 240, 1.0 / 60, 1.0 / 30, 0.1}) {
        for (const bool collide : {true, false}) {
          for (int draw = 0; draw < 2; ++draw) {
            StressCase one;
            one.name = std::string("state/") + row.name + "/" + stepName(step) + "/" + hairName(hair) +
                       (collide ? "/body/" : "/free/") + std::to_string(draw);
            one.hair = hair;
            one.start = row.start;
            one.start_size = row.size;
            one.step = step;
            one.collide = collide;
            one.seconds = 0.2;
            one.grace = 0.2;
            if (step > 0.05) one.release = 10;  // combing and buzzing are over after some steps, whatever their length
            one.in_short = draw == 0 && step == 1.0 / 60 && (collide || hair.style == app::Style::kLong);
            cases.push_back(one);
          }
        }
      }
    }
  }
}

void addUpsets(Cases& cases) {
  for (const UpsetRow& row : kUpsets) {
    for (const HairChoice& hair : lowStyles()) {
      for (const double step : {1.0 / 120, 1.0 / 60, 1.0 / 30, 0.1}) {
        StressCase one;
        one.name = std::string("upset/") + row.name + "/" + stepName(step) + "/" + hairName(hair);
        one.hair = hair;
        one.upset = row.upset;
        one.upset_size = row.size;
        one.grace = row.grace;
        one.meets = addsBody(row.upset);
        one.step = step;
        one.in_short = step == 1.0 / 60 && hair.style != app::Style::kShoulder;
        cases.push_back(one);
      }
    }
  }
}

// The same against signed distances of the skin: an arm that comes fast, bodies that rise and appear.
void addDistances(Cases& cases) {
  for (const UpsetRow& row : kUpsets) {
    for (const HairChoice& hair : lowStyles()) {
      StressCase one;
      one.name = std::string("distances/") + row.name + "/" + hairName(hair);
      one.hair = hair;
      one.upset = row.upset;
      one.upset_size = row.size;
      one.grace = row.grace;
      one.meets = addsBody(row.upset);
      one.params = {{"collider", static_cast<double>(sim::ColliderKind::kSdf)}};
      const bool body = row.upset == Upset::kBodyRise || row.upset == Upset::kArm || row.upset == Upset::kBury;
      one.in_short = hair.style == app::Style::kLong && (body || row.upset == Upset::kTurn);
      cases.push_back(one);
    }
  }
}

void addFaults(Cases& cases) {
  for (const HairChoice& hair : lowStyles()) {
    for (int draw = 0; draw < 20; ++draw) {
      StressCase one;
      one.name = "fault/" + hairName(hair) + "/" + std::to_string(draw);
      one.hair = hair;
      one.clip = "walk.bvh";
      one.play = Play::kForward;
      one.upset = Upset::kFault;
      one.recovers = true;
      one.in_short = draw < 2;
      cases.push_back(one);
    }
  }
}

}  // namespace stress
