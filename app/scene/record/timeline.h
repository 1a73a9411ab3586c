// The timeline: what was simulated is kept for a while, so that a person can go back to it, look, and go on from there.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/figure/character.h"
#include "app/scene/record/sim_cache.h"

namespace app {

// Rest positions (m, scalp frame) of each character's hair.
using RestShapes = std::vector<std::vector<Vec3>>;

// A kept moment; `state` as demoStateBytes.
struct TimelineFrame {
  long frame = 0;  // Timeline::now, then
  std::string state;
  double cost = 0;                                                     // s of simulation since the moment before
  bool contact = false, recovery = false, jump = false, loop = false;  // loop: the clip began anew
  long shapes = -1;                                                    // of Timeline::shapes; -1: those of now
  std::vector<double> after;  // s of each frame that followed, in its shapes, up to the next; below 0: a single step
  bool whole = false;         // nothing more follows in `after`: an edit has changed the shape
};

struct Timeline {
  bool on = false;  // of windows, recordings and replays
  long now = 0;     // frames since the run began in which time went on: paused ones are none
  std::deque<TimelineFrame> frames;
  std::size_t bytes = 0;
  double cost = 0;  // since the last kept moment
  bool contact = false, recovery = false, jump = false, loop = false;
  double clip_time = 0;               // s, of the first character
  long in = -1, out = -1;             // as `now`: at `out` it goes on from `in`; -1: not set
  bool baking = false;                // it is simulated up to `out` faster than shown
  std::unique_ptr<SimCache> cache;    // where there is one it is what the timeline shows
  std::map<long, RestShapes> shapes;  // that moments are of, and edits have changed since
  long cache_shapes = -1;             // of those; -1: the cache is of those of now
  long shown_of_cache = -1;           // frame of it that is shown and not simulated; -1: none
  bool anew = false;                  // what was kept of another hair mesh has gone, and little is kept since
};

inline constexpr long kTimelineEvery = 3;                              // frames between kept moments
inline constexpr std::size_t kTimelineBytes = std::size_t{192} << 20;  // the oldest go beyond it

inline constexpr std::size_t kAnewMoments = 40;  // after which `anew` has been said long enough

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

void forgetMoments(Timeline& timeline);
// The same because the hair has another mesh now, and none of the moments can be gone on from.
void beginAnew(Timeline& timeline);

// After an edit of the rest shape of a character's hair, which was `before` (m, scalp frame): moments from the present
// one on go, those before it stay, with the shape that they are of; so does a cache.
void keepEarlierMoments(int actor, const std::vector<Vec3>& before, Demo& demo);

// After a frame of `seconds`: one in which time went on is counted, and now and then kept.
void keepMoment(double seconds, Demo& demo);

// The point in or out at the present frame, or off (`on` false). Throws InputError where the two would not be in order.
void setInPoint(bool on, Demo& demo);
void setOutPoint(bool on, Demo& demo);

// Simulates `seconds` ahead of the in point, or of now, without drawing; then stands there. Throws InputError where
// nothing is kept of the in point, or of any moment.
void startBake(double seconds, Demo& demo);

// At the start of a frame: bakes a share of what is asked for, and goes back to the in point at the out point. What was
// kept of the in point may be gone: then both are off, and a message says so.
void followRange(Demo& demo);

// Goes to `frame`: to the last kept moment that is not after it, and on from there by the frames that followed; of a
// cache it is shown at once, without simulating. What is kept beyond it stays until time goes on. Throws InputError
// where none is kept. Steps from there end in the same bits as they did, with the same parameters; of hair that brushes
// have reshaped, to rounding. Of a moment before an edit of the rest shape the hair is shown as it was, and goes on
// from there in the shape of now.
void rewindTo(long frame, Demo& demo);

}  // namespace app
