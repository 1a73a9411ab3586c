// The timeline: what was simulated is kept for a while, so that a person can go back to it, look, and go on from there.
#pragma once

#include <deque>
#include <string>

namespace app {

struct Demo;

// A kept moment; `state` as demoStateBytes.
struct TimelineFrame {
  long frame = 0;
  std::string state;
  double cost = 0;  // s of simulation since the moment before
  bool contact = false, recovery = false, jump = false;
};

struct Timeline {
  bool on = false;  // of windows, recordings and replays
  std::deque<TimelineFrame> frames;
  std::size_t bytes = 0;
  double cost = 0;  // since the last kept moment
  bool contact = false, recovery = false, jump = false;
};

inline constexpr long kTimelineEvery = 3;                           // frames between kept moments
inline constexpr std::size_t kTimelineBytes = std::size_t{192} << 20;  // the oldest go beyond it

inline constexpr std::size_t kTimelineActors = 4;  // of larger crowds nothing is kept: it would cost too much

// What was kept is of other hair than what moves now.
void forgetMoments(Timeline& timeline);

// After a frame that took steps.
void keepMoment(Demo& demo);

// Goes to the last kept moment that is not after `frame`. What is kept beyond it stays until time goes on. Throws
// InputError where none is kept. Steps from there end in the same bits as they did, with the same parameters; of hair
// that brushes have reshaped, to rounding.
void rewindTo(long frame, Demo& demo);

}  // namespace app
