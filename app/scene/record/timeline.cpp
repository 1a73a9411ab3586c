#include "app/scene/record/timeline.h"

#include <algorithm>
#include <utility>

#include "app/files/errors.h"
#include "app/files/report_line.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"

namespace app {

void forgetMoments(Timeline& timeline) {
  timeline.baking = false;
  timeline.frames.clear();
  timeline.bytes = 0;
  timeline.cache.reset();
  timeline.shown_of_cache = -1;
}

bool timelineSpan(const Timeline& timeline, long& first, long& last) {
  if (timeline.cache) {
    first = timeline.cache->first();
    last = timeline.cache->last();
  } else if (!timeline.frames.empty()) {
    first = timeline.frames.front().frame;
    last = timeline.frames.back().frame;
  } else {
    return false;
  }
  return true;
}

long timelinePlace(const Demo& demo) {
  const Timeline& timeline = demo.timeline;
  if (!timeline.cache) return timeline.now;
  return timeline.shown_of_cache >= 0 ? timeline.shown_of_cache : demo.frames;
}

void openCache(const std::string& file, Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (file.empty()) {
    leaveCachedFrame(demo);
    timeline.cache.reset();
    timeline.shown_of_cache = -1;
    return;
  }
  timeline.cache = std::make_unique<SimCache>(file, demo);
  timeline.shown_of_cache = -1;
  demo.message = "cache of frames " + std::to_string(timeline.cache->first()) + " to " +
                 std::to_string(timeline.cache->last()) + "; drag along the timeline";
  demo.message_is_fault = false;
}

void leaveCachedFrame(Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (timeline.shown_of_cache < 0 || (demo.paused && demo.single_steps == 0)) return;
  const long shown = std::exchange(timeline.shown_of_cache, -1);
  if (!timeline.cache) return;
  try {
    timeline.cache->resume(shown, true, demo);
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
  }
}

namespace {

void keepNow(Demo& demo) {
  Timeline& timeline = demo.timeline;
  // What was simulated from here before is no longer what follows.
  while (!timeline.frames.empty() && timeline.frames.back().frame >= timeline.now) {
    timeline.bytes -= timeline.frames.back().state.size();
    timeline.frames.pop_back();
  }
  TimelineFrame kept{timeline.now,
                     demoStateBytes(demo),
                     std::exchange(timeline.cost, 0.0),
                     std::exchange(timeline.contact, false),
                     std::exchange(timeline.recovery, false),
                     std::exchange(timeline.jump, false),
                     std::exchange(timeline.loop, false)};
  timeline.bytes += kept.state.size();
  timeline.frames.push_back(std::move(kept));
  while (timeline.bytes > kTimelineBytes && timeline.frames.size() > 1) {
    timeline.bytes -= timeline.frames.front().state.size();
    timeline.frames.pop_front();
  }
}

}  // namespace

void keepMoment(Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (!demo.paused || demo.stats.steps > 0) ++timeline.now;
  if (!timeline.on || demo.stats.steps == 0 || demo.actors.size() > kTimelineActors) return;
  timeline.cost += demo.stats.simulation();
  timeline.contact |= demo.stats.corrected > 0;
  timeline.recovery |= demo.stats.recoveries > 0;
  timeline.jump |= demo.stats.carried > 0;
  const double clip_time = demo.actors.front().playback.time;
  timeline.loop |= clip_time < std::exchange(timeline.clip_time, clip_time);
  if (timeline.now % kTimelineEvery == 0) keepNow(demo);
}

void setInPoint(bool on, Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (on && timeline.out >= 0 && timeline.now >= timeline.out)
    throw InputError("", "", "the in point would lie behind the out point", "clear the out point first");
  timeline.in = on ? timeline.now : -1;
}

void setOutPoint(bool on, Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (on && timeline.now <= timeline.in)
    throw InputError("", "", "the out point would lie before the in point", "go on a little, or clear the in point");
  timeline.out = on ? timeline.now : -1;
}

void startBake(double seconds, Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (!timeline.on || demo.actors.size() > kTimelineActors)
    throw InputError("", "", "of so many characters no moments are kept", "export the hair, or take some away");
  if (timeline.in < 0) {
    timeline.in = timeline.now;
    keepNow(demo);
  }
  rewindTo(timeline.in, demo);
  timeline.in = timeline.now;
  if (timeline.out <= timeline.in)
    timeline.out = timeline.in + static_cast<long>(std::clamp(seconds, 0.1, 600.0) * demo.scene.playback.fps);
  timeline.baking = true;
  demo.paused = false;
}

void followRange(Demo& demo) {
  if (std::exchange(demo.timeline.baking, false)) {
    const double fps = demo.scene.playback.fps;
    for (int k = 0; k < kBakedFrames && demo.timeline.now < demo.timeline.out; ++k) advanceFrame(demo, 1 / fps, {});
    demo.timeline.baking = demo.timeline.now < demo.timeline.out;
    if (demo.timeline.baking) return;
    demo.message = "baked " + countOf(demo.timeline.out - demo.timeline.in, "frame");
    demo.message_is_fault = false;
    demo.paused = true;
    return rewindTo(demo.timeline.in, demo);
  }
  Timeline& timeline = demo.timeline;
  if (demo.paused || timeline.in < 0 || timeline.out < 0 || timeline.now < timeline.out) return;
  try {
    rewindTo(timeline.in, demo);
  } catch (const InputError&) {
    timeline.in = timeline.out = -1;
    demo.message = "the in point is no longer kept; it was cleared with the out point";
    demo.message_is_fault = true;
  }
}

void rewindTo(long frame, Demo& demo) {
  if (SimCache* cache = demo.timeline.cache.get()) {
    const long within = std::clamp(frame, cache->first(), cache->last());
    const bool paused = demo.paused;
    cache->show(within, demo);
    demo.paused = paused;
    demo.timeline.shown_of_cache = within;
    return;
  }
  const std::deque<TimelineFrame>& frames = demo.timeline.frames;
  const auto after = std::upper_bound(frames.begin(), frames.end(), frame,
                                      [](long wanted, const TimelineFrame& kept) { return wanted < kept.frame; });
  if (after == frames.begin())
    throw InputError("", "", "nothing is kept of that moment", "go to one on the timeline, or to the start");
  const bool paused = demo.paused;
  restoreDemoState(std::prev(after)->state, "timeline", true, demo);
  demo.timeline.now = std::prev(after)->frame;
  demo.paused = paused;
  demo.shown_fraction = -1;
}

}  // namespace app
