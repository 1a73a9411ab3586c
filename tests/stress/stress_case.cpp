#include "tests/stress/stress_case.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "sim/field_text.h"
#include "tests/stress/matrix.h"
#include "tests/stress/stage.h"

namespace stress {
namespace {

struct FamilyTitle {
  const char* family;
  const char* title;
};
constexpr std::array<FamilyTitle, 14> kTitles{{
    {"step", "fixed time steps from 1/480 to 1/10 s"},
    {"pace", "steps, and frames through the clock, of 1 to 500 ms drawn anew each time"},
    {"speed", "playback at 1 to 50 times, own clips and motion capture"},
    {"scrub", "scrubbing backwards, jumps in time with and without carrying the hair along"},
    {"style", "nine styles, uneven columns, a single bundle, 10,000 vertices"},
    {"soak", "an hour of dance and of walk; memory and timing flat"},
    {"param", "every parameter at its minimum and maximum, every choice"},
    {"stiffness", "stiffness and mass at 1e-3 to 1e3 of their defaults"},
    {"random-params", "random combinations over the whole ranges of all parameters"},
    {"restless", "parameters drawn anew every step"},
    {"paper", "the paper's claims, with our settings and with its solver"},
    {"state", "collapsed, flattened, inverted, inside out, shuffled, noise, thrown, stretched"},
    {"upset", "turns, teleports, spins, shakes, bodies through and within the hair"},
    {"fault", "values not finite or absurd written into random vertices ten times a second"},
}};

}  // namespace

const char* familyTitle(const std::string& family) {
  for (const FamilyTitle& row : kTitles) {
    if (family == row.family) return row.title;
  }
  return "draws over all axes at once";
}

namespace {

// Of these some fail today; docs/stability.md tells which. They are for the long run until they are mended.
bool fallsShort(const std::string& name) {
  constexpr const char* kBeginnings[] = {"step/1-10s/",           "speed/20x/",     "speed/50x/", "state/shuffled/",
                                         "upset/switch-on-12cm/", "random-params/", "mixed/"};
  return std::any_of(std::begin(kBeginnings), std::end(kBeginnings),
                     [&](const char* beginning) { return name.starts_with(beginning); });
}

}  // namespace

std::vector<StressCase> declareCases(std::uint64_t seed) {
  Cases cases;
  addPaper(cases);
  addStyles(cases);
  addSteps(cases);
  addPaces(cases);
  addSpeeds(cases);
  addScrubs(cases);
  addParameters(cases);
  addStiffness(cases);
  addStates(cases);
  addUpsets(cases);
  addFaults(cases);
  addRestless(cases);
  addRandomParameters(seed, cases);
  addMixed(seed, cases);
  addSoak(cases);
  for (StressCase& one : cases) one.in_short = one.in_short && !fallsShort(one.name);
  return cases;
}

sim::ColliderKind colliderOf(const StressCase& one) {
  sim::SimParams params;
  for (const auto& [name, value] : one.params) {
    if (name == "collider") sim::findParam(name)->set(params, value);
  }
  return params.collider;
}

WindowCommand windowCommand(const StressCase& one) {
  WindowCommand window;
  window.command = "hairmesh --motion " + findClip(one.clip) + " --style " +
                   std::string(sim::styleName(one.hair.style)) + " --resolution " +
                   std::string(sim::resolutionName(one.hair.resolution));
  const auto also = [&](const std::string& text) { window.note += (window.note.empty() ? "" : "; ") + text; };
  if (one.play == Play::kForward) window.command += " --speed " + sim::numberText(one.speed);
  if (one.play == Play::kStill) window.command += " --speed 0";
  if (one.play == Play::kBackward || one.play == Play::kJumps || one.play == Play::kCarryJumps)
    also("scrub in the Motion panel");
  window.command += " --set time_step=" + sim::numberText(one.step);
  if (!one.collide) window.command += " --set collide=off";
  for (const auto& [name, value] : one.params) {
    sim::SimParams params;
    const sim::ParamField& field = *sim::findParam(name);
    field.set(params, value);
    window.command += " --set " + name + "=" + sim::paramText(field, params);
  }
  if (one.hair.cut != Cut::kStyle) also("the hair mesh is cut from this style");
  if (one.start == Start::kCollapsed)
    also("collapse with the button");
  else if (one.start != Start::kSettled)
    also("the start state is the stress run's own");
  if (one.upset != Upset::kNone) also("the disturbance is the stress run's own");
  if (one.pace != Pace::kFixed) also("the pace is the stress run's own");
  if (one.restless) also("parameters are drawn anew every step");
  return window;
}

}  // namespace stress
