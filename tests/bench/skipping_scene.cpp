#include "tests/bench/skipping_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/files/data_path.h"
#include "app/scene/demo.h"
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
  app::addDrawing(report.skip_counts, picturing.row.skipped);
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

// A renderer for each set of skips, all fed with the frames of one simulation.
struct Pictures {
  std::vector<Picturing> all;

  Picturing& add(const char* name, const app::SkipSet& skips) {
    Picturing& one = all.emplace_back();
    one.skips = skips;
    one.row.skips = name;
    one.renderer = std::make_unique<render::Renderer>(app::dataPath("shaders"));
    return one;
  }
  Simulated simulate(const SceneRun& run, const app::SkipSet& skips) {
    return bench::simulate(run, skips, [&](app::Demo& demo) {
      for (Picturing& one : all) draw(run, demo, one);
    });
  }
};

app::SkipSet onlySkip(app::SkipId id) {
  app::SkipSet skips = noSkips();
  skips.on[id] = true;
  return skips;
}

void writeLast(const SceneRun& run, const std::string& folder, const char* name, const Picturing& picturing) {
  app::writePng(folder + "/skipping_" + app::stem(run.file) + "_" + name + ".png", run.width, run.height,
                picturing.images.back().rgba);
}

// With all skips on: which of them leave anything out here. The others are not measured alone.
Simulated simulateWithAll(const SceneRun& run, Pictures& pictures) {
  pictures.add("all", app::SkipSet{});
  if (run.close_up_strands > 0) pictures.add("like the close-up", app::SkipSet{}).strands = run.close_up_strands;
  Simulated all = pictures.simulate(run, app::SkipSet{});
  SkipRow& row = pictures.all.front().row;
  for (std::size_t s = 0; s < row.skipped.size(); ++s) {
    if (row.skipped[s].of == 0) row.skipped[s] = all.row.skipped[s];
  }
  for (Picturing& one : pictures.all) one.renderer.reset();
  return all;
}

// Each drawing skip alone, on the frames of the run without any skip, and that run first.
Simulated simulateWithout(const SceneRun& run, const app::SkipCounts& used, Pictures& pictures) {
  pictures.add("none", noSkips());
  for (const app::Skip& skip : app::skipTable()) {
    if (isDrawing(skip) && used[skip.id].skipped > 0) pictures.add(skip.name, onlySkip(skip.id));
  }
  return pictures.simulate(run, noSkips());
}

// Each simulation and character skip alone.
void measureSimulationSkips(const SceneRun& run, const app::SkipCounts& used, const Simulated& plain,
                            std::vector<SkipRow>& rows) {
  const double plain_drawing = rows.front().drawing_ms;
  for (const app::Skip& skip : app::skipTable()) {
    if (isDrawing(skip) || skip.id == app::kSkipEvents || used[skip.id].skipped == 0) continue;
    Simulated alone = simulate(run, onlySkip(skip.id));
    compareShapes(plain, alone, alone.row);
    alone.row.skips = skip.name;
    alone.row.drawing_ms = plain_drawing;
    rows.push_back(alone.row);
  }
}

}  // namespace

std::vector<SkipRow> measureScene(const SceneRun& run, const std::string& folder) {
  const std::string scene = app::stem(run.file);
  Pictures with_all;
  const Simulated all = simulateWithAll(run, with_all);
  std::printf("%s: with all skips done\n", scene.c_str());
  writeLast(run, folder, "all", with_all.all.front());
  SkipRow& last = with_all.all.front().row;

  std::vector<SkipRow> rows;
  std::vector<app::Image> reference;
  Simulated plain;
  {
    Pictures without;
    plain = simulateWithout(run, last.skipped, without);
    std::printf("%s: without skips done\n", scene.c_str());
    writeLast(run, folder, "none", without.all.front());
    reference = without.all.front().images;
    for (Picturing& one : without.all) {
      finish(reference, one);
      one.row.simulation_ms = plain.row.simulation_ms;
      one.row.character_ms = plain.row.character_ms;
      rows.push_back(one.row);
    }
  }
  measureSimulationSkips(run, last.skipped, plain, rows);
  for (Picturing& one : with_all.all) finish(reference, one);
  if (with_all.all.size() > 1) last.drawing_like_close_up_ms = with_all.all.back().row.drawing_ms;
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
