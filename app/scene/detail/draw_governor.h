// The drawing governor: holds the drawing of a frame to so many milliseconds by walking a ladder of measured settings.
//
// A rung thins strands and shadow strands by the level of detail (render/hair/hair_detail.h: strands leave one after
// another, fading, and those that stay grow wider) and lets segments grow longer. The governor watches what the drawing
// of a frame takes on this machine, and goes down to the rung whose predicted time fits when that is over the budget,
// up to the finest whose predicted time fits well below it. Between rungs settings glide, so that nothing pops. What a
// climb by one rung really cost is remembered, and one that had to be taken back lets the next one wait twice as long:
// it never swings between two rungs.
//
// Time is what the driver's timer queries say, wall time where it draws on the CPU (render/gl/gpu_timer.h). Pictures
// drawn under a budget depend on the machine: two runs do not repeat to the bit. Hair and recordings do not depend on
// them.
#pragma once

#include <array>
#include <span>
#include <string>

#include "render/frame_input.h"

namespace app {

struct DrawRung {
  const char* name;
  double strands;         // share of those that the level of detail asks for
  double segment_error;   // times the view's
  double shadow_strands;  // share
  double cost, error;     // of a frame and its picture over the first rung's: geometric means over the measured scenes
};

// From full detail to the cheapest; costs fall and errors rise. See draw_governor.cpp for how it was measured.
std::span<const DrawRung> drawLadder();
inline constexpr int kMaxDrawRungs = 8;

struct DrawGovernor {
  double budget = 0;  // s a frame; 0: off, all is drawn as it is set
  int rung = 0;
  double place = 0;          // on the ladder, between rungs while settings glide
  double measured_cost = 0;  // s a frame, median of the last window
  bool over_budget = false;  // the cheapest rung takes longer
  long changes = 0;

  static constexpr int kWindow = 7;          // frames between decisions
  std::array<double, kWindow> window{};      // s, of the frames since the last decision
  int frames = 0;                            // in the window
  int settle = 0;                            // frames to let pass before measuring
  double since_change = 0, backoff = 0;      // s; of waiting before a climb
  bool climbed = false;                      // the last change was a climb
  double left_cost = 0;                      // s, at the rung that it came from; 0: learned from already
  std::array<double, kMaxDrawRungs> rise{};  // learned cost of rung k over rung k + 1; 0: the ladder's
};

// Starts governing at `seconds` a frame, or ends it with 0. What was learned of the ladder stays.
void setDrawBudget(double seconds, DrawGovernor& governor);

// Lets settings glide on by a frame of `seconds` before it is drawn.
void glide(double seconds, DrawGovernor& governor);

// Takes in what the drawing of a frame took, `seconds` after the one before; changes the rung when it is time to.
// Returns whether it did. Frames that were kept from the one before are not to be told.
bool observeDrawing(double seconds, double cost, DrawGovernor& governor);

// Puts the settings in effect into a frame; leaves it as it is when the governor is off.
void governDrawing(const DrawGovernor& governor, render::FrameInput& frame);

// "60 % of the strands"
std::string drawRungName(const DrawGovernor& governor);

}  // namespace app
