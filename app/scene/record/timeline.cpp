#include "app/scene/record/timeline.h"

#include <algorithm>
#include <set>
#include <utility>

#include "app/files/errors.h"
#include "app/files/report_line.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "app/scene/edit/groom_brush.h"

namespace app {

namespace {

std::size_t bytesOf(const RestShapes& shapes) {
  std::size_t bytes = 0;
  for (const std::vector<Vec3>& shape : shapes) bytes += shape.size() * sizeof(Vec3);
  return bytes;
}

void forgetShapesOfNone(Timeline& timeline) {
  if (timeline.shapes.empty()) return;
  std::set<long> used{timeline.cache_shapes};
  for (const TimelineFrame& frame : timeline.frames) used.insert(frame.shapes);
  for (auto at = timeline.shapes.begin(); at != timeline.shapes.end();) {
    const bool keep = used.contains(at->first);
    if (!keep) timeline.bytes -= bytesOf(at->second);
    at = keep ? std::next(at) : timeline.shapes.erase(at);
  }
}

void forgetFrom(long frame, Timeline& timeline) {
  while (!timeline.frames.empty() && timeline.frames.back().frame >= frame) {
    timeline.bytes -= timeline.frames.back().state.size();
    timeline.frames.pop_back();
  }
  forgetShapesOfNone(timeline);
}

}  // namespace

void forgetMoments(Timeline& timeline) {
  timeline.baking = timeline.anew = false;
  timeline.frames.clear();
  timeline.shapes.clear();
  timeline.bytes = 0;
  timeline.cache.reset();
  timeline.cache_shapes = -1;
  timeline.shown_of_cache = -1;
}

void beginAnew(Timeline& timeline) {
  const bool kept = timeline.anew || !timeline.frames.empty() || timeline.cache;
  forgetMoments(timeline);
  timeline.anew = kept;
}

void keepEarlierMoments(int actor, const std::vector<Vec3>& before, Demo& demo) {
  Timeline& timeline = demo.timeline;
  forgetFrom(timeline.now, timeline);
  const bool of_moments = !timeline.frames.empty() && timeline.frames.back().shapes < 0;
  const bool of_cache = timeline.cache && timeline.cache_shapes < 0;
  if (!of_moments && !of_cache) return;
  RestShapes were;
  for (const Actor& one : demo.actors) were.push_back(one.haircut->mesh.shape.positions);
  were[static_cast<std::size_t>(actor)] = before;
  timeline.bytes += bytesOf(were);
  const long number = timeline.shapes.empty() ? 0 : timeline.shapes.rbegin()->first + 1;
  timeline.shapes.emplace(number, std::move(were));
  if (of_cache) timeline.cache_shapes = number;
  // Those before the edit before have theirs.
  for (auto frame = timeline.frames.rbegin(); frame != timeline.frames.rend() && frame->shapes < 0; ++frame)
    frame->shapes = number, frame->whole = true;
}

namespace {

// `number`: of Timeline::shapes, or -1.
void inShapesOf(long number, const std::function<void()>& act, Demo& demo) {
  if (number < 0) return act();
  inShapes(demo.timeline.shapes.at(number), act, demo);
}

}  // namespace

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
    timeline.cache_shapes = -1;
    timeline.shown_of_cache = -1;
    return;
  }
  timeline.cache = std::make_unique<SimCache>(file, demo);
  timeline.cache_shapes = -1;
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
    inShapesOf(
        timeline.cache_shapes, [&] { timeline.cache->resume(shown, true, demo); }, demo);
  } catch (const std::exception& fault) {
    demo.message = fault.what();
    demo.message_is_fault = true;
  }
}

namespace {

// The last kept moment that is not after `frame`; the end where there is none.
std::deque<TimelineFrame>::iterator momentAt(long frame, std::deque<TimelineFrame>& frames) {
  const auto after = std::upper_bound(frames.begin(), frames.end(), frame,
                                      [](long wanted, const TimelineFrame& kept) { return wanted < kept.frame; });
  return after == frames.begin() ? frames.end() : std::prev(after);
}

// The frame that has just been simulated follows a kept moment.
void noteAfter(double seconds, const Demo& demo, Timeline& timeline) {
  constexpr std::size_t kMost = 60;
  const auto kept = momentAt(timeline.now - 1, timeline.frames);
  if (kept == timeline.frames.end() || kept->whole) return;
  const auto place = static_cast<std::size_t>(timeline.now - 1 - kept->frame);
  if (place > kept->after.size() || place >= kMost) return;
  kept->after.resize(place);
  kept->after.push_back(demo.paused ? -1 : seconds);
}

void keepNow(Demo& demo) {
  Timeline& timeline = demo.timeline;
  forgetFrom(timeline.now, timeline);  // what was simulated from here before is no longer what follows
  TimelineFrame kept{timeline.now,
                     demoStateBytes(demo),
                     std::exchange(timeline.cost, 0.0),
                     std::exchange(timeline.contact, false),
                     std::exchange(timeline.recovery, false),
                     std::exchange(timeline.jump, false),
                     std::exchange(timeline.loop, false),
                     -1,
                     {},
                     false};
  timeline.bytes += kept.state.size();
  timeline.frames.push_back(std::move(kept));
  timeline.anew = timeline.anew && timeline.frames.size() < kAnewMoments;
  while (timeline.bytes > kTimelineBytes && timeline.frames.size() > 1) {
    timeline.bytes -= timeline.frames.front().state.size();
    timeline.frames.pop_front();
    forgetShapesOfNone(timeline);
  }
}

}  // namespace

void keepMoment(double seconds, Demo& demo) {
  Timeline& timeline = demo.timeline;
  if (!demo.paused || demo.stats.steps > 0) {
    ++timeline.now;
    noteAfter(seconds, demo, timeline);
  }
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
    inShapesOf(
        demo.timeline.cache_shapes, [&] { cache->show(within, demo); }, demo);
    demo.paused = paused;
    demo.timeline.shown_of_cache = within;
    return;
  }
  const auto kept = momentAt(frame, demo.timeline.frames);
  if (kept == demo.timeline.frames.end())
    throw InputError("", "", "nothing is kept of that moment", "go to one on the timeline, or to the start");
  const bool paused = demo.paused;
  const auto on = std::min(static_cast<std::size_t>(frame - kept->frame), kept->after.size());
  inShapesOf(
      kept->shapes,
      [&] {
        restoreDemoState(kept->state, "timeline", true, demo);
        for (std::size_t k = 0; k < on; ++k) simulateAgain(kept->after[k], demo);
      },
      demo);
  demo.timeline.now = kept->frame + static_cast<long>(on);
  demo.paused = paused;
  demo.shown_fraction = -1;
}

}  // namespace app
