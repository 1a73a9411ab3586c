// What a stability case is: hair, motion, disturbance, start, pace and parameters, and what it takes to pass.
//
// A case has three parts. *Motion*: the hair is treated as the case says. *Rest*: head and body stand still. *Release*,
// if the hair is not back by then: the colliders are removed, for hair may rest on the other side of a shoulder. The
// hair is back if every vertex is within 1 % of the hair length of a reference hair, the same hair released from the
// rest pose when the motion stopped.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/sim_params.h"
#include "sim/stabilization/safety_nets.h"
#include "app/styles/hair_styles.h"

namespace stress {

enum class Cut { kStyle, kUneven, kSingleBundle, kTenThousand };

struct HairChoice {
  Cut cut = Cut::kStyle;
  app::Style style = app::Style::kShort;
  app::Resolution resolution = app::Resolution::kLow;
};

// How a clip is played.
enum class Play {
  kStill,      // its first pose
  kForward,    // at `speed`, looping
  kBackward,   // scrubbed backwards at `speed`
  kJumps,      // to another moment every quarter second, the hair dragged along
  kCarryJumps  // the same with the hair carried along, as the window's slider does
};

// What is done to the figure beside its clip.
enum class Upset {
  kNone,
  kTurn,      // the head turned by 180 degrees within one step, twice a second
  kTeleport,  // the figure moved by `upset_size` m within one step, twice a second
  kSpin,      // the figure spun at `upset_size` rad/s
  kShake,     // the figure shaken, amplitude 0.2 m, at `upset_size` Hz
  kNod,       // the head rolled by one radian either way at `upset_size` Hz, the body still
  kBodyRise,  // the body's colliders pushed up through the hair by `upset_size` m and back, four times a second
  kArm,       // an arm swung through the hair at `upset_size` m/s
  kSwitchOn,  // an ellipsoid of radius `upset_size` m appears within the hair
  kBury,      // an ellipsoid appears that holds the root layer and more
  kFault      // values that are not finite or absurd written into random vertices, once every tenth of a second
};

// What state the hair starts from.
enum class Start {
  kSettled,
  kCollapsed,  // every vertex on its root (figure 8 of the paper)
  kFlattened,  // one layer onto the layer below
  kInverted,   // layers pushed to the other side of their neighbours
  kInsideOut,  // mirrored through the roots
  kShuffled,   // positions exchanged among the vertices
  kNoise,      // random offsets up to `start_size` m
  kFast,       // random velocities of `start_size` m/s
  kStretched   // `start_size` times as long
};

enum class Pace {
  kFixed,        // steps of `step`
  kRandomSteps,  // steps of 1 to 500 ms, drawn anew each time
  kRandomFrames  // frames of 1 to 500 ms through the fixed-step clock
};

struct StressCase {
  std::string name;  // "family/..."
  HairChoice hair;
  std::string clip = "idle_turns.bvh";
  Play play = Play::kStill;
  double speed = 1;
  Upset upset = Upset::kNone;
  double upset_size = 0;
  Start start = Start::kSettled;
  double start_size = 0;
  Pace pace = Pace::kFixed;
  double step = 1.0 / 60;                              // s
  std::vector<std::pair<std::string, double>> params;  // rows of the table that differ from its defaults
  bool redraws_parameters = false;                     // parameters drawn anew every step of the motion
  bool switches = false;                               // contacts on and off as well
  bool collide = true;
  double seconds = 1;        // of motion
  double rounds = 0;         // of the clip, in place of seconds where there are any: 4 to 60 s
  std::string loop;          // what the figure does at the clip's end, as --loop; empty: what suits the clip
  double max_work = 0;       // units a vertex (sim/step_work.h) that no step of the motion exceeds; 0: not judged
  bool sees_skin = false;    // strands are looked at against the drawn skin; judged where by_forces is
  bool by_forces = false;    // no column is guided home during the motion
  double rest = 1;           // s with the body there
  double release = 5;        // s without, from when the reference hair rests; back within rest + release
  double grace = 0;          // s after each start or appearance in which vertices may still be inside
  bool recovers = false;     // state repairs are expected
  sim::SafetyNets nets;      // in use; less than all to measure what one saves
  bool returns = true;       // judged by its way back to rest too: not the published step, which has no nets
  bool compared = false;     // a peer's setting, shown beside ours and not counted
  bool keeps_energy = true;  // judged by its energy too: not where the numerics are turned to their coarsest
  bool meets = false;        // the body that is added must come upon the hair
  bool in_short = false;     // runs with --short
  bool endurance = false;    // memory and timing must stay flat

  std::string family() const { return name.substr(0, name.find('/')); }
};

// What the case's hair collides with.
sim::ColliderKind colliderOf(const StressCase& one);

// All cases that a seed declares, in a fixed order. Names are unique.
std::vector<StressCase> declareCases(std::uint64_t seed);

// The `hairmesh` command line that shows the case in the window as far as options can say it; `note` tells what they
// cannot.
struct WindowCommand {
  std::string command, note;
};
WindowCommand windowCommand(const StressCase& one);

// Whether a case's outcome decides over the run's: those of a peer are shown beside.
inline bool counts(const StressCase& one) {
  return !one.compared;
}

}  // namespace stress
