// The timeline: what was simulated is kept for a while, so that a person can go back to it, look, and go on from there.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "app/scene/record/sim_cache.h"

namespace app {

// A kept moment; `state` as demoStateBytes.
struct TimelineFrame {
  long frame = 0;  // Timeline::now, then
  std::string state;
  double cost = 0;                                                     // s of simulation since the moment before
  bool contact = false, recovery = false, jump = false, loop = false;  // loop: the clip began anew
};

struct Timeline {
  bool on = false;  // of windows, recordings and replays
  long now = 0;     // frames since the run began in which time went on: paused ones are none
  std::deque<TimelineFrame> frames;
  std::size_t bytes = 0;
  double cost = 0;  // since the last kept moment
  bool contact = false, recovery = false, jump = false, loop = false;
  double clip_time = 0;             // s, of the first character
  long in = -1, out = -1;           // as `now`: at `out` it goes on from `in`; -1: not set
  bool baking = false;              // it is simulated up to `out` faster than shown
  std::unique_ptr<SimCache> cache;  // where there is one it is what the timeline shows
  long shown_of_cache = -1;         // frame of it that is shown and not simulated; -1: none
};

inline constexpr long kTimelineEvery = 3;                              // frames between kept moments
inline constexpr std::size_t kTimelineBytes = std::size_t{192} << 20;  // the oldest go beyond it

inline constexpr int kBakedFrames = 8;  // in the time of one that is shown

inline constexpr std::size_t kTimelineActors = 4;  // of larger crowds nothing is kept: it would cost too much

// First and last frame that can be gone to; false where there is none.
bool timelineSpan(const Timeline& timeline, long& first, long& last);
// The one that is shown.
long timelinePlace(const Demo& demo);

// The timeline shows a cache from now on; with an empty name what is kept in memory. Throws InputError.
void openCache(const std::string& file, Demo& demo);

// Before a frame's steps: where a cached frame is shown, and time goes on, it goes on from the last whole state before
// it. A fault becomes the demo's message.
void leaveCachedFrame(Demo& demo);

// What was kept is of other hair than what moves now.
void forgetMoments(Timeline& timeline);

// After a frame: one in which time went on is counted, and now and then kept.
void keepMoment(Demo& demo);

// The point in or out at the present frame, or off (`on` false). Throws InputError where the two would not be in order.
void setInPoint(bool on, Demo& demo);
void setOutPoint(bool on, Demo& demo);

// Simulates `seconds` ahead of the in point, or of now, without drawing; then stands there. Throws InputError where
// nothing is kept of the in point, or of any moment.
void startBake(double seconds, Demo& demo);

// At the start of a frame: bakes a share of what is asked for, and goes back to the in point at the out point. What was
// kept of the in point may be gone: then both are off, and a message says so.
void followRange(Demo& demo);

// Goes to the last kept moment that is not after `frame`; of a cache it is shown at once, without simulating. What is
// kept beyond it stays until time goes on. Throws InputError where none is kept. Steps from there end in the same bits
// as they did, with the same parameters; of hair that brushes have reshaped, to rounding.
void rewindTo(long frame, Demo& demo);

}  // namespace app
