// Draws over all axes at once: the bulk of the long run.
#include <algorithm>
#include <array>

#include "tests/stress/matrix.h"
#include "tests/stress/random.h"

namespace stress {
namespace {

constexpr int kDraws = 7000;

template <class T, std::size_t N>
T pick(const std::array<T, N>& values, Random& random) {
  return values[random.below(static_cast<int>(N))];
}

void drawMotion(Random& random, StressCase& one) {
  const int clips = static_cast<int>(ownClips().size() + capturedClips().size());
  const int clip = random.below(clips);
  const int own = static_cast<int>(ownClips().size());
  one.clip = clip < own ? ownClips()[clip] : capturedClips()[clip - own];
  one.play = pick(std::array{Play::kStill, Play::kForward, Play::kForward, Play::kForward, Play::kBackward,
                             Play::kJumps, Play::kCarryJumps},
                  random);
  one.speed = pick(std::array{1.0, 2.0, 5.0, 10.0, 20.0, 50.0}, random);
}

void drawUpset(Random& random, StressCase& one) {
  one.upset = pick(std::array{Upset::kNone, Upset::kNone, Upset::kTurn, Upset::kTeleport, Upset::kSpin, Upset::kShake,
                              Upset::kNod, Upset::kBodyRise, Upset::kArm, Upset::kSwitchOn, Upset::kBury},
                   random);
  switch (one.upset) {
    case Upset::kTeleport:
      one.upset_size = random.logarithmic(0.05, 100);
      break;
    case Upset::kSpin:
      one.upset_size = random.logarithmic(1, 100);
      break;
    case Upset::kShake:
    case Upset::kNod:
      one.upset_size = random.logarithmic(0.5, 20);
      break;
    case Upset::kBodyRise:
      one.upset_size = random(0.02, 0.15);
      break;
    case Upset::kArm:
      one.upset_size = random.logarithmic(0.5, 50);
      break;
    case Upset::kSwitchOn:
      one.upset_size = random(0.02, 0.12);
      break;
    default:
      break;
  }
  if (one.upset == Upset::kSwitchOn || one.upset == Upset::kBury) one.grace = 0.1;
}

void drawStart(Random& random, StressCase& one) {
  if (random.chance(0.6)) return;
  one.start = pick(std::array{Start::kCollapsed, Start::kFlattened, Start::kInverted, Start::kInsideOut,
                              Start::kShuffled, Start::kNoise, Start::kFast, Start::kStretched},
                   random);
  one.start_size = one.start == Start::kNoise       ? random.logarithmic(0.005, 0.2)
                   : one.start == Start::kFast      ? random.logarithmic(1, 100)
                   : one.start == Start::kStretched ? random.logarithmic(0.1, 3)
                                                    : 0;
  one.grace = 0.2;
}

// A row or three turned moderately: within a decade of the default, or a tenth of the range for rows that are not
// logarithmic.
void drawParameters(Random& random, StressCase& one) {
  const int rows = random.below(4);
  for (int k = 0; k < rows; ++k) {
    const auto fields = sim::paramFields();
    const sim::ParamField& field = fields[random.below(static_cast<int>(fields.size()))];
    if (field.kind != sim::FieldKind::kReal || std::string_view(field.group) == "Numerics") continue;
    if (std::string_view(field.group) == "Time") continue;
    double value = field.logarithmic ? field.default_value * random.logarithmic(0.1, 10)
                                     : field.default_value + random(-0.1, 0.1) * (field.maximum - field.minimum);
    value = std::min(std::max(value, field.minimum), field.maximum);
    one.params.emplace_back(field.name, value);
  }
}

}  // namespace

void addMixed(std::uint64_t seed, Cases& cases) {
  for (int k = 0; k < kDraws; ++k) {
    StressCase one;
    one.name = "mixed/" + std::to_string(k);
    Random random(seed, one.name);
    one.hair = lowStyles()[random.below(3)];
    if (random.chance(0.1)) one.hair.cut = random.chance(0.5) ? Cut::kUneven : Cut::kSingleBundle;
    drawMotion(random, one);
    drawUpset(random, one);
    drawStart(random, one);
    if (one.play == Play::kCarryJumps) one.grace = std::max(one.grace, 0.1);
    drawParameters(random, one);
    one.step = pick(std::array{1.0 / 240, 1.0 / 120, 1.0 / 60, 1.0 / 60, 1.0 / 60, 1.0 / 60, 1.0 / 60, 1.0 / 30,
                               1.0 / 30, 0.05, 0.1},
                    random);
    if (random.chance(0.15)) one.pace = random.chance(0.5) ? Pace::kRandomSteps : Pace::kRandomFrames;
    if (one.pace != Pace::kFixed) one.step = 1.0 / 60;
    one.seconds = 0.5;
    one.rest = 0.5;
    one.release = 30;
    // For the long run: violent enough that another processor's rounding may change what becomes of a draw.
    cases.push_back(one);
  }
}

}  // namespace stress
