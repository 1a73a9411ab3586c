#include "tests/stress/stress_case.h"

#include <filesystem>

#include "sim/field_text.h"
#include "tests/stress/matrix.h"
#include "tests/stress/stage.h"

namespace stress {
std::vector<StressCase> declareCases(std::uint64_t seed) {
  Cases cases;
  addPaper(cases);
  addStyles(cases);
  addSteps(cases);
  addLadder(cases);
  addPaces(cases);
  addSpeeds(cases);
  addScrubs(cases);
  addParameters(cases);
  addStiffness(cases);
  addPresets(cases);
  addStates(cases);
  addUpsets(cases);
  addDistances(cases);
  addFaults(cases);
  addRedrawnParameters(cases);
  addRandomParameters(seed, cases);
  addMixed(seed, cases);
  addEndurance(cases);
  addCaptures(cases);
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
  window.command = "hairmesh --motion '";
  window.command += findClip(one.clip);
  if (one.clip.ends_with(".mot"))
    window.command +=
        "' --parts '" + (std::filesystem::path(findClip(one.clip)).parent_path() / "female-objs").string();
  window.command += "' --style " + std::string(app::styleName(one.hair.style));
  window.command += " --resolution " + std::string(app::resolutionName(one.hair.resolution));
  const auto also = [&](const std::string& text) { window.note += (window.note.empty() ? "" : "; ") + text; };
  if (one.play == Play::kForward) window.command += " --speed " + sim::numberText(one.speed);
  if (!one.loop.empty()) window.command += " --loop " + one.loop;
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
  if (one.redraws_parameters) also("parameters are drawn anew every step");
  return window;
}

}  // namespace stress
