#include "app/scene/timeline.h"

#include <algorithm>
#include <utility>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"

namespace app {

void forgetMoments(Timeline& timeline) {
  timeline.frames.clear();
  timeline.bytes = 0;
}

void keepMoment(Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (!timeline.on || demo.stats.steps == 0 || demo.actors.size() > kTimelineActors) return;
  timeline.cost += demo.stats.simulation();
  timeline.contact |= demo.stats.corrected > 0;
  timeline.recovery |= demo.stats.recoveries > 0;
  timeline.jump |= demo.stats.carried > 0;
  if (demo.frames % kTimelineEvery != 0) return;
  // What was simulated from here before is no longer what follows.
  while (!timeline.frames.empty() && timeline.frames.back().frame >= demo.frames) {
    timeline.bytes -= timeline.frames.back().state.size();
    timeline.frames.pop_back();
  }
  TimelineFrame kept{demo.frames, demoStateBytes(demo), std::exchange(timeline.cost, 0.0),
                     std::exchange(timeline.contact, false), std::exchange(timeline.recovery, false),
                     std::exchange(timeline.jump, false)};
  timeline.bytes += kept.state.size();
  timeline.frames.push_back(std::move(kept));
  while (timeline.bytes > kTimelineBytes && timeline.frames.size() > 1) {
    timeline.bytes -= timeline.frames.front().state.size();
    timeline.frames.pop_front();
  }
}

void rewindTo(long frame, Demo& demo) {
  const std::deque<TimelineFrame>& frames = demo.timeline.frames;
  const auto after = std::upper_bound(frames.begin(), frames.end(), frame,
                                      [](long wanted, const TimelineFrame& kept) { return wanted < kept.frame; });
  if (after == frames.begin())
    throw InputError("", "", "nothing is kept of that moment", "go to one on the timeline, or to the start");
  const bool paused = demo.paused;
  restoreDemoState(std::prev(after)->state, "timeline", true, demo);
  demo.paused = paused;
  demo.shown_fraction = -1;
}

}  // namespace app
