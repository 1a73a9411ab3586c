#include "app/platform/headless.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>
#include <regex>

#include "app/debug_option.h"
#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/files/image_io.h"
#include "app/files/output_file.h"
#include "app/files/recording.h"
#include "app/files/report.h"
#include "app/files/report_line.h"
#include "app/platform/egl_context.h"
#include "app/platform/interrupt.h"
#include "app/platform/opening.h"
#include "app/platform/video.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "app/scene/record/hair_export.h"
#include "app/scene/record/sim_cache.h"
#include "render/gl/gl_messages.h"

namespace app {

namespace {

constexpr double kLineEvery = 5;  // s

std::string framePath(const std::string& folder, long frame) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%04ld.png", frame);
  return (std::filesystem::path(folder) / name).string();
}

// The number in "frame_0123.png", or -1.
long frameNumber(const std::string& name) {
  static const std::regex pattern("frame_([0-9]{4,9})\\.png");
  std::smatch match;
  return std::regex_match(name, match, pattern) ? std::stol(match[1]) : -1;
}

// What an earlier, longer run has left beyond frame `last`; empty when there is nothing. It stays: only who made it
// knows whether it is still wanted.
std::string staleFrames(const std::string& folder, long last) {
  std::vector<long> beyond;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const long number = frameNumber(entry.path().filename().string());
    if (number > last) beyond.push_back(number);
  }
  if (beyond.empty()) return "";
  const auto [low, high] = std::minmax_element(beyond.begin(), beyond.end());
  return folder + " holds " + std::to_string(beyond.size()) + " frames of an earlier run as well, " +
         framePath("", *low) + " to " + framePath("", *high) + "; remove them before the frames become a film\n";
}

// What only a run with pictures has. The renderer goes before its context.
struct Pictures {
  explicit Pictures(bool debug) : context(debug) {}
  EglContext context;
  render::Renderer renderer{dataPath("shaders")};
  render::PicturePair pair{dataPath("shaders")};
};

// One run from the first frame to the last, to an interrupt, or to a picture that cannot be written.
struct Run {
  const Options& options;
  Tape tape;
  Demo demo;
  RunReport report;
  std::optional<OutputFolder> folder;
  std::optional<Pictures> pictures;
  std::optional<VideoWriter> film;
  std::optional<HairExport> hair_export;
  std::optional<SimCacheWriter> cache;
  std::vector<unsigned char> pixels;
  int frames = 0;
  int first = 0;  // number of the first frame: a loaded state has some behind it

  Run(Scene scene, const Options& run_options);
  void drawFrames();
  bool drawsAll() const;
  void openExport();
  void exportFrame(int frame);
  double frameSeconds(int frame) const;
  void saveState() const;
  void reportDone();
  int finish();
};

Demo openForPictures(Scene scene, const Options& options, double aspect) {
  const bool kept_whole = !options.hair_export.file.empty() || !options.cache.empty();
  if (kept_whole) simulateAll(scene.skips);
  Demo demo = openAsked(std::move(scene), options, aspect, false);
  if (kept_whole) simulateAll(demo.scene.skips);
  setDebugViews(options.debug, demo.debug);
  demo.governor.counted = demo.deadline.counted = true;  // the same pictures on every run
  for (const std::string& note : openingNotes(options, demo)) std::cerr << "hairmesh: " << note << "\n";
  return demo;
}

Run::Run(Scene scene, const Options& run_options) : options(run_options), tape(options, scene) {
  const double start = now();
  report.fps = scene.playback.fps;
  frames = tape.frames().value_or(options.frames);
  if (!options.report.empty()) checkWritable(options.report);
  if (!options.screenshot.empty()) checkWritable(options.screenshot);
  if (options.keep_frames) folder.emplace(options.out, "choose another with --out DIR");
  if (!options.video.empty()) film.emplace(options.video, options.width, options.height, report.fps);
  if (!options.save_state.empty()) checkWritable(options.save_state);
  if (!options.hair_export.file.empty()) checkWritable(options.hair_export.file);
  demo = openForPictures(std::move(scene), options, tape.aspect());
  if (!options.load_state.empty()) {
    const bool keep_view = !options.camera.empty() || !options.framing.empty();
    loadDemoState(options.load_state, keep_view, demo);
    report.first = first = static_cast<int>(demo.frames);
  }
  if (!options.compare.empty()) startComparison(options.compare, demo);
  demo.comparison.side_by_side = options.compare_view == "side";
  if (!options.hair_export.file.empty()) openExport();
  if (!options.cache.empty()) cache.emplace(options.cache, demo);
  if (options.keep_frames) checkWritable(framePath(options.out, first));
  if (!options.no_images) {
    pictures.emplace(options.gl_debug);
    report.renderer = render::rendererName();
  }
  report.start_seconds = now() - start;
}

void Run::openExport() {
  const ExportSpec& spec = options.hair_export;
  const int end = first + frames;
  if (std::max(spec.first, spec.last) >= end || (spec.last >= 0 && spec.last < first))
    throw UsageError("--export-frames does not lie within the run's " + countOf(frames, "frame") + ", " +
                     std::to_string(first) + " to " + std::to_string(end - 1) + "; give others, or more --frames");
  hair_export.emplace(spec, demo, report.fps, first, end);
}

// The first frame of a scene shows its start, the first after a loaded state goes on. What a frame's further moments
// have taken is left out of the next.
double Run::frameSeconds(int frame) const {
  if (frame == 0 && options.load_state.empty()) return 0;
  const ExportSpec& spec = options.hair_export;
  const bool further = hair_export && spec.samples > 1 && spec.takes(first + frame - 1);
  return (1 - (further ? spec.shutter : 0)) / report.fps;
}

void Run::exportFrame(int frame) {  // its number
  const ExportSpec& spec = options.hair_export;
  if (!hair_export || !spec.takes(frame)) return;
  hair_export->add(demo, frame);
  for (int sample = 1; sample < spec.samples; ++sample) {
    advanceFrame(demo, spec.shutter / ((spec.samples - 1) * report.fps), {});
    addWork(demo.stats, report.frames.back());
    hair_export->add(demo, frame);
  }
}

void Run::saveState() const {
  writeFile(options.save_state, demoStateBytes(demo));
  std::cout << "state after " << countOf(demo.frames, "frame") << " in " << options.save_state << "\n";
}

// Whether more is asked for than the picture at the end. Drawing is part of a report, and is measured for a budget.
bool Run::drawsAll() const {
  return options.keep_frames || film || !options.report.empty() || options.gl_debug ||
         demo.scene.playback.draw_budget_ms > 0;
}

void Run::drawFrames() {
  FrameTarget target;
  if (pictures)
    target = {&pictures->renderer, options.width, options.height, 0, &pixels, !options.report.empty(), {},
              &pictures->pair};
  double last_line = now();
  std::string told = demo.message;  // with the opening notes
  bool shown = false;
  for (int frame = 0; frame < frames && !interrupted(); ++frame) {
    shown = drawsAll() || frame == 0 || frame + 1 == frames;  // the first tells the picture's size
    advanceFrame(demo, tape.turn(frame, frameSeconds(frame), demo), shown ? target : FrameTarget{});
    report.frames.push_back(demo.stats);
    if (cache) cache->add(demo);
    if (frame + 1 == options.save_state_at) saveState();
    if (const std::string note = numericalNote(demo.stats); !note.empty())
      std::cerr << "hairmesh: frame " << first + frame << ": " << note << "\n";
    if (demo.message_is_fault && !demo.message.empty() && demo.message != told)
      std::cerr << "hairmesh: frame " << first + frame << ": " << demo.message << "\n";
    told = demo.message;
    if (options.keep_frames) writePng(framePath(options.out, first + frame), options.width, options.height, pixels);
    if (film) film->add(pixels);
    exportFrame(first + frame);
    // A person wants to see that it goes on.
    if (now() - last_line > kLineEvery) {
      std::cout << "frame " << frame + 1 << " of " << frames << std::endl;
      last_line = now();
    }
  }
  if (pictures && !pixels.empty() && !shown) drawFrame(demo, target);
  if (pictures && !pixels.empty() && !options.screenshot.empty())
    writePng(options.screenshot, options.width, options.height, pixels);
}

// After a fault: where the report cannot be written either, the first fault counts.
void Run::reportDone() {
  try {
    if (!options.report.empty()) writeReport(options.report, report, demo);
  } catch (const OutputError&) {
  }
}

int Run::finish() {
  if (!options.report.empty()) writeReport(options.report, report, demo);
  for (const Actor& actor : demo.actors) {
    for (const std::string& note : actor.body->character.notes)
      std::cout << stem(actor.spec.motion) << ": " << note << "\n";
    std::cout << stem(actor.spec.motion) << ": at the clip's end: " << loopText(actor.playback.loop) << "\n";
    if (demo.actors.size() > 1) break;
  }
  if (hair_export) std::cout << hair_export->finish(demo);
  if (cache) std::cout << cache->finish(demo);
  std::cout << summary(report, demo);
  if (demo.comparison.on() && demo.comparison.frames > 0)
    std::cout << "against " << options.compare << ": " << comparisonText(demo) << "\n";
  if (film) {
    film->finish();
    std::cout << countOf(report.frames.size(), "frame") << " in " << options.video << film->sizeNote() << "\n";
  }
  if (options.keep_frames) {
    std::cout << countOf(report.frames.size(), "frame") << " in " << options.out;
    if (first > 0) std::cout << ", from " << framePath("", first);
    std::cout << "\n"
              << tape.sizeNote(options.width, options.height)
              << staleFrames(options.out, first + std::ssize(report.frames) - 1);
  }
  const bool saved = options.save_state_at > 0 && options.save_state_at <= std::ssize(report.frames);
  if (!options.save_state.empty() && !saved) saveState();
  const Tape::End end = tape.end(demo);
  std::cout << end.message;
  if (!options.replay.empty() && options.no_images)
    std::cout << "replayed without pictures; --headless --out DIR would keep them\n";
  if (endedEarly(static_cast<int>(report.frames.size()), frames)) return kExitInterrupted;
  if (options.gl_debug && render::glMessageCount() > 0)
    std::cerr << "hairmesh: the driver had " << render::glMessageCount() << " things to say of OpenGL calls\n";
  return end.differs || render::glMessageCount() > 0 ? kExitFault : kExitFine;
}

}  // namespace

int runHeadless(Scene scene, const Options& options) {
  noteInterrupts();
  Run run(std::move(scene), options);
  try {
    run.drawFrames();
  } catch (const OutputError&) {
    run.reportDone();
    throw;
  }
  return run.finish();
}

}  // namespace app
