#include "tests/bench/skipping_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/data_path.h"
#include "app/demo.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/skipping_simulation.h"

namespace bench {
namespace {

bool isDrawing(const app::Skip& skip) {
  return std::string(skip.stage) == "drawing";
}

// A renderer with its own switches, fed with the frames of one run.
struct Picturing {
  app::SkipSet skips;
  int strands = 0;  // a head, in place of the run's, with the light's own shadow maps
  SkipRow row;
  std::unique_ptr<render::Renderer> renderer;
  std::vector<double> seconds;
  std::vector<app::Image> images;
};

void draw(const SceneRun& run, app::Demo& demo, Picturing& picturing) {
  const app::SkipSet own = demo.scene.skips;
  demo.scene.skips = picturing.skips;
  render::FrameInput input = app::frameInput(demo, run.width, run.height);
  demo.scene.skips = own;
  if (picturing.strands > 0) {
    for (render::HairInput& hair : demo.hair_inputs) hair.strands = picturing.strands;
  } else if (run.shadow_size > 0) {
    input.light.shadow_size = run.shadow_size;
  }
  app::Image image{run.width, run.height, {}};
  const double start = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
  const render::FrameReport report = picturing.renderer->renderImage(input, image.rgba);
  picturing.seconds.push_back(secondsOf(CLOCK_PROCESS_CPUTIME_ID) - start);
  picturing.images.push_back(std::move(image));
  picturing.row.gpu_bytes_hair = report.gpu_bytes_hair;
  picturing.row.gpu_bytes_shadows = report.gpu_bytes_shadows;
  app::addDrawing(report.left_out, picturing.row.skipped);
}

double imageError(const app::Image& a, const app::Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 != 3) sum += std::abs(static_cast<int>(a.rgba[i]) - static_cast<int>(b.rgba[i]));
  }
  return sum / (0.75 * static_cast<double>(a.rgba.size()));
}

void finish(const std::vector<app::Image>& reference, Picturing& picturing) {
  // The first picture brings everything to the GPU.
  std::vector<double>& seconds = picturing.seconds;
  if (seconds.size() > 1) seconds.erase(seconds.begin());
  if (!seconds.empty()) picturing.row.drawing_ms = 1e3 * medianOf(seconds);
  for (std::size_t i = 0; i < reference.size(); ++i)
    picturing.row.image_error = std::max(picturing.row.image_error, imageError(reference[i], picturing.images[i]));
}

}  // namespace

std::vector<SkipRow> measureScene(const SceneRun& run, const std::string& folder) {
  std::vector<SkipRow> rows;
  const std::string scene = app::stem(run.file);
  std::vector<Picturing> picturing;
  const auto add = [&](const char* name, const app::SkipSet& skips) {
    Picturing& one = picturing.emplace_back();
    one.skips = skips;
    one.row.skips = name;
    one.renderer = std::make_unique<render::Renderer>(app::dataPath("shaders"));
  };
  const auto pictures = [&](app::Demo& demo) {
    for (Picturing& one : picturing) draw(run, demo, one);
  };
  const auto picture = [&](const char* name, const app::Image& image) {
    app::writePng(folder + "/skipping_" + scene + "_" + name + ".png", run.width, run.height, image.rgba);
  };

  // With all of them first: it shows which leave anything out here. The others are not measured alone.
  add("all", app::SkipSet{});
  if (run.close_up_strands > 0) {
    add("like the close-up", app::SkipSet{});
    picturing.back().strands = run.close_up_strands;
  }
  const Simulated all = simulate(run, app::SkipSet{}, pictures);
  std::printf("%s: with all skips done\n", scene.c_str());
  std::vector<Picturing> with_all = std::move(picturing);
  SkipRow& last = with_all.front().row;
  for (std::size_t s = 0; s < last.skipped.size(); ++s) {
    if (last.skipped[s].of == 0) last.skipped[s] = all.row.skipped[s];
  }
  picture("all", with_all.front().images.back());
  for (Picturing& one : with_all) one.renderer.reset();

  // The drawing skips are shown the frames of the run without any skip.
  picturing.clear();
  add("none", noSkips());
  for (const app::Skip& skip : app::skipTable()) {
    if (!isDrawing(skip) || last.skipped[skip.id].skipped == 0) continue;
    app::SkipSet one = noSkips();
    one.on[skip.id] = true;
    add(skip.name, one);
  }
  const Simulated plain = simulate(run, noSkips(), pictures);
  std::printf("%s: without skips done\n", scene.c_str());
  const std::vector<app::Image> reference = picturing.front().images;
  for (Picturing& one : picturing) {
    finish(reference, one);
    one.row.simulation_ms = plain.row.simulation_ms;
    one.row.character_ms = plain.row.character_ms;
    rows.push_back(one.row);
  }
  picture("none", reference.back());
  const double plain_drawing = rows.front().drawing_ms;
  picturing.clear();

  for (const app::Skip& skip : app::skipTable()) {
    if (isDrawing(skip) || skip.id == app::kSkipEvents || last.skipped[skip.id].skipped == 0) continue;
    app::SkipSet one = noSkips();
    one.on[skip.id] = true;
    Simulated alone = simulate(run, one);
    compareShapes(plain, alone, alone.row);
    alone.row.skips = skip.name;
    alone.row.drawing_ms = plain_drawing;
    rows.push_back(alone.row);
  }
  for (Picturing& one : with_all) finish(reference, one);
  if (with_all.size() > 1) last.drawing_like_close_up_ms = with_all.back().row.drawing_ms;
  last.simulation_ms = all.row.simulation_ms;
  last.character_ms = all.row.character_ms;
  compareShapes(plain, all, last);
  rows.push_back(last);
  const std::string strands = run.strands > 0 ? std::to_string(run.strands) : "the scene's number of";
  for (SkipRow& one : rows) {
    one.scene = scene;
    one.setup =
        std::to_string(run.width) + "x" + std::to_string(run.height) + " pixels, " + strands + " strands a head";
  }
  return rows;
}

}  // namespace bench
