#include "app/platform/opening.h"

#include <cstdio>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "app/files/report.h"
#include "app/scene/edit/paint_brush.h"
#include "app/scene/project.h"
#include "sim/field_text.h"

namespace app {

namespace {

Demo openFile(Scene scene, const Options& options, double aspect, bool beside) {
  if (options.project.empty()) return openScene(std::move(scene), aspect, beside);
  const bool keep_view = !options.camera.empty() || !options.framing.empty();
  Demo demo = readProject(options.project, scene, keep_view, aspect);
  const bool stands = demo.paused && options.headless;
  if (!options.record.empty()) {
    demo = openScene(std::move(scene), aspect, beside);
    demo.requests.push_back({Ask::kOpenProject, "", std::filesystem::absolute(options.project).string(), 1});
  }
  if (stands) demo.requests.push_back({Ask::kPause, "", "", 0});
  return demo;
}

std::string secondsText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g s", seconds);
  return text;
}

// Characters that are to begin where their clip has ended.
void noteLateStarts(const Options& options, const Demo& demo, std::vector<std::string>& notes) {
  for (std::size_t n = 0; n < demo.actors.size(); ++n) {
    const Actor& actor = demo.actors[n];
    const double asked = actor.spec.clip_offset, duration = actor.playedClip().duration();
    if (asked <= duration) continue;
    const bool stops = actor.playback.loop.kind == LoopKind::kStop;
    const std::string place = demo.actors.size() > 1 ? " of character " + std::to_string(n + 1) : "";
    notes.push_back((options.start >= 0 ? "--start " : "\"clip_offset\" ") + sim::numberText(asked) + place +
                    " lies beyond the clip's " + secondsText(duration) + "; it begins at " +
                    secondsText(actor.playback.time) + (stops ? ", its end" : ", for the clip goes round"));
  }
}

}  // namespace

Demo openAsked(Scene scene, const Options& options, double aspect, bool beside) {
  Demo demo = openFile(std::move(scene), options, aspect, beside);
  if (options.turntable != 0)
    demo.requests.push_back({Ask::kTurntable, "", "", options.turntable * std::numbers::pi / 180});
  return demo;
}

std::vector<std::string> openingNotes(const Options& options, const Demo& demo) {
  std::vector<std::string> notes;
  std::istringstream lines(demo.message);
  for (std::string line; std::getline(lines, line);) notes.push_back(line);
  if (demo.paused && options.headless) notes.push_back(options.project + " was saved paused; here it plays");
  for (std::string& note : limitNotes(demo)) notes.push_back(std::move(note));
  if (options.project.empty() || options.start >= 0) noteLateStarts(options, demo, notes);
  const Actor& first = demo.actors.front();
  for (const char* field : {"curl", "clump"})
    if (std::string note = paintNote(field, first.spec); !note.empty()) notes.push_back(std::move(note));
  for (const Actor& actor : demo.actors)
    if (std::string note = idlePinNote(actor); !note.empty()) notes.push_back(std::move(note));
  if (options.out_given && !options.headless)
    notes.push_back("--out is the folder of runs without a window: add --headless, or record this window by key K");
  if (demo.draw_governor.budget > 0 && options.headless && !options.no_images)
    notes.push_back("--draw-budget-ms goes by measured time: these pictures do not repeat to the bit");
  return notes;
}

}  // namespace app
