#include "app/headless.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "app/data_path.h"
#include "app/debug_option.h"
#include "app/demo.h"
#include "app/egl_context.h"
#include "app/errors.h"
#include "app/image_io.h"
#include "app/recording.h"
#include "app/report.h"

namespace app {

namespace {

constexpr double kTellEvery = 5;  // s

std::string framePath(const std::string& folder, int frame) {
  char name[32];
  std::snprintf(name, sizeof name, "frame_%04d.png", frame);
  return (std::filesystem::path(folder) / name).string();
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder, "", "is not a folder and cannot be made one", "choose another with --out DIR");
  }
}

// What only a run with pictures has. The renderer goes before its context.
struct Pictures {
  EglContext context;
  render::Renderer renderer{dataPath("shaders")};
};

}  // namespace

int runHeadless(Scene scene, const Options& options) {
  const double start = now();
  Tape tape(options, scene);
  const double fps = scene.playback.fps;
  const int frames = tape.frames().value_or(options.frames);
  Demo demo = openScene(std::move(scene), tape.aspect());
  setDebugViews(options.debug, demo.debug);
  demo.governor.counted = true;  // the same pictures on every run

  RunReport run;
  run.fps = fps;
  std::optional<Pictures> pictures;
  std::vector<unsigned char> pixels;
  FrameTarget target;
  if (!options.no_images) {
    makeFolder(options.out);
    pictures.emplace();
    run.renderer = render::rendererName();
    target = {&pictures->renderer, options.width, options.height, 0, &pixels, !options.report.empty(), {}};
  }
  run.start_seconds = now() - start;

  double told = now();
  for (int frame = 0; frame < frames; ++frame) {
    advanceFrame(demo, tape.turn(frame, frame == 0 ? 0 : 1 / fps, demo), target);
    run.frames.push_back(demo.stats);
    if (const std::string trouble = numericalNote(demo.stats); !trouble.empty())
      std::cerr << "hairmesh: frame " << frame << ": " << trouble << "\n";
    if (!pictures) continue;
    writePng(framePath(options.out, frame), options.width, options.height, pixels);
    // Software rasterizers take a second a frame; a person wants to see that it goes on.
    if (now() - told > kTellEvery) {
      std::cout << "frame " << frame + 1 << " of " << frames << std::endl;
      told = now();
    }
  }
  if (pictures && !options.screenshot.empty()) writePng(options.screenshot, options.width, options.height, pixels);
  if (!options.report.empty()) writeReport(options.report, run, demo);
  for (const Actor& actor : demo.actors) {
    for (const std::string& note : actor.body->character.notes)
      std::cout << stem(actor.spec.motion) << ": " << note << "\n";
    if (demo.actors.size() > 1) break;
  }
  std::cout << summary(run);
  if (pictures) std::cout << frames << " frames in " << options.out << "\n";
  const Tape::End end = tape.end(demo);
  std::cout << end.said;
  return end.differs ? kExitFault : kExitFine;
}

}  // namespace app
