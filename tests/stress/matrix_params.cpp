// Parameters at their limits, stiffness ratios, random combinations, changes every step, and the paper's settings.
#include <array>
#include <cmath>
#include <span>

#include "app/files/data_path.h"
#include "app/files/presets.h"
#include "tests/stress/matrix.h"
#include "tests/stress/random.h"
#include "tests/stress/stage.h"

namespace stress {
namespace {

constexpr std::array<const char*, 6> kModuli{"stretch_along", "stretch_across", "stretch_edge",
                                             "shear",         "bend",           "volume"};
constexpr int kRandomCombinations = 1000, kRedrawnRuns = 60;
// Of rows whose effect is a time constant: hair in thick air or with slow relaxation needs longer to come back.
constexpr double kSlowRelease = 30;  // s

double defaultOf(const char* name) {
  return sim::findParam(name)->default_value;
}

double clamped(const sim::ParamField& field, double value) {
  return std::min(std::max(value, field.minimum), field.maximum);
}

// The time step is an axis of its own.
bool ownAxis(const sim::ParamField& field) {
  return std::string_view(field.name) == "time_step";
}

}  // namespace

bool hasNets(const sim::ParamField& field, double drawn) {
  return std::string_view(field.name) != "solver" || drawn != static_cast<double>(sim::Solver::kPaper);
}

double draw(const sim::ParamField& field, Random& random) {
  switch (field.kind) {
    case sim::FieldKind::kSwitch:
      return random.below(2);
    case sim::FieldKind::kChoice:
      return random.below(static_cast<int>(field.choices.size()));
    default:
      break;
  }
  const double value =
      field.logarithmic ? random.logarithmic(field.minimum, field.maximum) : random(field.minimum, field.maximum);
  return field.kind == sim::FieldKind::kInteger ? clamped(field, std::round(value)) : value;
}

void addParameters(Cases& cases) {
  for (const sim::ParamField& field : sim::paramFields()) {
    if (ownAxis(field)) continue;
    std::vector<std::pair<std::string, double>> values;
    if (field.kind == sim::FieldKind::kChoice) {
      for (std::size_t k = 0; k < field.choices.size(); ++k)
        values.emplace_back(field.choices[k], static_cast<double>(k));
    } else {
      values = {{"min", field.minimum}, {"max", field.maximum}};
    }
    for (const auto& [label, value] : values) {
      for (const HairChoice& hair : lowStyles()) {
        if (hair.style == app::Style::kShoulder) continue;
        StressCase dance;
        dance.name = std::string("param/") + field.name + "-" + label + "/dance/" + hairName(hair);
        dance.hair = hair;
        dance.clip = "dance.bvh";
        dance.play = Play::kForward;
        dance.params = {{field.name, value}};
        dance.release = kSlowRelease;
        dance.keeps_energy = std::string_view(field.group) != "Numerics";
        dance.returns = hasNets(field, value);
        // Of frames that are long enough for it to matter.
        if (std::string_view(field.name) == "max_steps_per_frame") dance.pace = Pace::kRandomFrames;
        dance.in_short = hair.style == app::Style::kShort;
        cases.push_back(dance);
        StressCase collapsed = dance;
        collapsed.name = std::string("param/") + field.name + "-" + label + "/collapsed/" + hairName(hair);
        collapsed.clip = "idle_turns.bvh";
        collapsed.play = Play::kStill;
        collapsed.start = Start::kCollapsed;
        collapsed.seconds = 0.5;
        collapsed.grace = 0.2;
        collapsed.in_short = false;
        cases.push_back(collapsed);
      }
    }
  }
}

void addStiffness(Cases& cases) {
  std::vector<std::string> rows(kModuli.begin(), kModuli.end());
  rows.insert(rows.end(), {"all", "density"});
  for (const std::string& row : rows) {
    for (int decade = -3; decade <= 3; ++decade) {
      if (decade == 0) continue;
      for (const HairChoice& hair : lowStyles()) {
        for (const char* clip : {"dance.bvh", "head_shake.bvh"}) {
          StressCase one;
          const std::string name = clip;
          one.name = "stiffness/" + row + "-1e" + std::to_string(decade) + "/" + name.substr(0, name.find('.')) + "/" +
                     hairName(hair);
          one.hair = hair;
          one.clip = clip;
          one.play = Play::kForward;
          one.release = kSlowRelease;
          const double ratio = std::pow(10.0, decade);
          for (const char* modulus : kModuli) {
            if (row == modulus || row == "all") one.params.emplace_back(modulus, ratio * defaultOf(modulus));
          }
          if (row == "density") one.params.emplace_back("density", ratio * defaultOf("density"));
          one.in_short = std::abs(decade) == 3 && hair.style == app::Style::kShort && name == "dance.bvh";
          cases.push_back(one);
        }
      }
    }
  }
}

void addPresets(Cases& cases) {
  for (const std::string& file : app::listAssets("presets", {".json"})) {
    sim::SimParams params;
    app::SceneLook look;
    app::loadPreset(file, {&params, &look, {}});
    if (!app::presetSections(file).sim || params.solver == sim::Solver::kPaper) continue;
    StressCase one;
    for (const sim::ParamField& field : sim::paramFields()) {
      if (!ownAxis(field) && field.get(params) != field.default_value)
        one.params.emplace_back(field.name, field.get(params));
    }
    one.play = Play::kForward;
    one.release = kSlowRelease;
    for (const sim::Integrator integrator : {sim::Integrator::kLinearizedEuler, sim::Integrator::kBdf2}) {
      const bool two_step = integrator == sim::Integrator::kBdf2, opened = app::stem(file) == "natural";
      if (two_step) one.params.emplace_back("integrator", static_cast<double>(integrator));
      one.keeps_energy = !two_step;  // BDF2 goes on from where the roots were moving
      for (const HairChoice& hair : lowStyles()) {
        for (const char* clip : ownClips()) {
          one.hair = hair;
          one.clip = clip;
          one.name = "preset/" + app::stem(file) + (two_step ? "-bdf2/" : "/") + app::stem(clip) + "/" + hairName(hair);
          one.in_short = opened && (one.clip == "dance.bvh" || (!two_step && one.clip == "head_shake.bvh"));
          cases.push_back(one);
        }
      }
    }
  }
}

void addRandomParameters(std::uint64_t seed, Cases& cases) {
  for (int k = 0; k < kRandomCombinations; ++k) {
    StressCase one;
    one.name = "random-params/" + std::to_string(k);
    Random random(seed, one.name);
    one.hair = lowStyles()[random.below(3)];
    one.clip = ownClips()[random.below(5)];
    one.play = Play::kForward;
    const double share = random(0.1, 1);
    for (const sim::ParamField& field : sim::paramFields()) {
      if (ownAxis(field) || !random.chance(share)) continue;
      const double drawn = draw(field, random);
      if (hasNets(field, drawn)) one.params.emplace_back(field.name, drawn);
      // Ten iterations a solve, or a tolerance of a half, keep no such law.
      one.keeps_energy = one.keeps_energy && std::string_view(field.group) != "Numerics";
    }
    one.seconds = 0.5;
    one.release = kSlowRelease;
    cases.push_back(one);  // for the long run: a draw may take minutes (thousands of iterations at 1e-12)
  }
}

void addRedrawnParameters(Cases& cases) {
  for (int k = 0; k < kRedrawnRuns; ++k) {
    StressCase one;
    one.name = "redrawn-params/" + std::to_string(k);
    one.hair = lowStyles()[k % 3];
    one.clip = ownClips()[k % 5];
    one.play = Play::kForward;
    one.redraws_parameters = true;
    // What has come inside while contacts were off is out after a while.
    one.switches = k % 2 == 1;
    if (one.switches) one.grace = 0.5;
    one.in_short = k < 6;
    cases.push_back(one);
  }
}

namespace {

// A claim of the paper, with our settings and with its solver. `change` makes the case.
template <class Change>
void addClaim(Cases& cases, const std::string& name, Change&& change, std::span<const HairChoice> hairs = lowStyles()) {
  for (const HairChoice& hair : hairs) {
    StressCase ours;
    ours.name = "paper/" + name + "/ours/" + hairName(hair);
    ours.hair = hair;
    ours.in_short = true;
    change(ours);
    StressCase theirs = ours;
    theirs.name = "paper/" + name + "/its-solver/" + hairName(hair);
    theirs.params.insert(theirs.params.begin(), {"max_iterations", 400});  // unless the claim says how many
    theirs.params.insert(theirs.params.end(), {{"solver", static_cast<double>(sim::Solver::kPaper)},
                                               {"integrator", static_cast<double>(sim::Integrator::kLinearizedEuler)},
                                               {"precision", static_cast<double>(sim::Precision::kFloat)}});
    theirs.compared = true;
    cases.push_back(ours);
    cases.push_back(theirs);
  }
}

// Figures 7 to 9: fast playback, collapse, an arm through the hair.
void addPaperFigures(Cases& cases) {
  for (const double speed : {10.0, 20.0, 50.0}) {
    addClaim(cases, "playback-" + plain(speed) + "x", [&](StressCase& one) {
      one.clip = "dance.bvh";
      one.play = Play::kForward;
      one.speed = speed;
      one.collide = false;
      one.seconds = 2;
    });
  }
  for (const bool collide : {false, true}) {
    addClaim(cases, collide ? "collapse-with-body" : "collapse", [&](StressCase& one) {
      one.start = Start::kCollapsed;
      one.collide = collide;
      one.seconds = 0.1;
      one.grace = 0.1;
    });
  }
  for (const bool minimize : {true, false}) {
    addClaim(cases, minimize ? "arm-minimized" : "arm-not-minimized", [&](StressCase& one) {
      one.upset = Upset::kArm;
      one.upset_size = 5;
      one.meets = true;
      one.compared = !minimize;
      one.params = {{"minimize_deformation", minimize}};
    });
  }
}

// What its text claims beside them: large steps, stiff hair, impossible states, violent motion, few iterations.
void addPaperText(Cases& cases) {
  for (const double step : {1.0 / 30, 0.1}) {
    addClaim(cases, "step-" + stepName(step), [&](StressCase& one) {
      one.clip = "dance.bvh";
      one.play = Play::kForward;
      one.step = step;
      one.speed = 5;
    });
  }
  addClaim(cases, "stiff-1e3", [&](StressCase& one) {
    one.clip = "dance.bvh";
    one.play = Play::kForward;
    for (const char* modulus : kModuli) one.params.emplace_back(modulus, 1e3 * defaultOf(modulus));
  });
  // Where hair may be left tangled.
  for (const Start start : {Start::kInsideOut, Start::kShuffled}) {
    addClaim(cases, start == Start::kInsideOut ? "inside-out" : "shuffled", [&](StressCase& one) {
      one.start = start;
      one.collide = false;
      one.seconds = 0.2;
    });
  }
  addClaim(cases, "head-shake-20x", [&](StressCase& one) {
    one.clip = "head_shake.bvh";
    one.play = Play::kForward;
    one.speed = 20;
    one.seconds = 2;
  });
  // The paper does not say how many iterations it takes: on its largest mesh so many.
  const HairChoice large{Cut::kStyle, app::Style::kLong, app::Resolution::kHigh};
  for (const int most : {50, 100}) {
    addClaim(
        cases, "collapse-" + plain(most) + "-iterations",
        [&](StressCase& one) {
          one.start = Start::kCollapsed;
          one.collide = false;
          one.seconds = 0.1;
          one.params = {{"max_iterations", most}};
          one.in_short = false;
        },
        std::span(&large, 1));
  }
}

}  // namespace

void addPaper(Cases& cases) {
  addPaperFigures(cases);
  addPaperText(cases);
}

}  // namespace stress
