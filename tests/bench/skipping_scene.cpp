#include "tests/bench/skipping_scene.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "app/data_path.h"
#include "app/demo.h"
#include "app/level_of_detail.h"

namespace bench {
namespace {

// Pixels: the simulation takes the care that a picture of this height asks for, however small the measured ones are.
constexpr int kSeenHeight = 720;

double seconds(clockid_t clock) {
  timespec moment{};
  clock_gettime(clock, &moment);
  return static_cast<double>(moment.tv_sec) + 1e-9 * static_cast<double>(moment.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

bool isDrawing(const app::Skip& skip) {
  return std::string(skip.stage) == "drawing";
}

app::SkipSet none() {
  app::SkipSet skips;
  skips.on.fill(false);
  return skips;
}

// A renderer with its own switches, fed with the frames of one run.
struct Picturing {
  app::SkipSet skips;
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
  app::Image image{run.width, run.height, {}};
  const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
  const render::FrameReport report = picturing.renderer->renderImage(input, image.rgba);
  picturing.seconds.push_back(seconds(CLOCK_PROCESS_CPUTIME_ID) - start);
  picturing.images.push_back(std::move(image));
  picturing.row.gpu_bytes_hair = report.gpu_bytes_hair;
  picturing.row.gpu_bytes_shadows = report.gpu_bytes_shadows;
  app::addDrawing(report.left_out, picturing.row.skipped);
}

// What a run of the simulation showed, per drawn frame and actor.
using Shown = std::vector<std::vector<std::vector<float>>>;

struct Simulated {
  SkipRow row;
  Shown shown;
  std::vector<double> metre;  // pixels, per actor
  std::vector<bool> seen;
};

Simulated simulate(const SceneRun& run, const app::SkipSet& skips, std::vector<Picturing*> picturing) {
  app::Scene scene = app::loadScene(app::dataPath("assets/scenes/" + run.file));
  scene.skips = skips;
  for (app::CharacterSpec& spec : scene.characters) {
    if (run.strands > 0) spec.look.strands = run.strands;
  }
  if (run.shadow_size > 0) scene.look.light.shadow_size = run.shadow_size;
  app::Demo demo = app::openScene(std::move(scene), static_cast<double>(run.width) / run.height);
  demo.picture_height = kSeenHeight;
  Simulated done;
  std::vector<double> simulation, character;
  for (int frame = 0; frame < run.frames; ++frame) {
    const double start = seconds(CLOCK_THREAD_CPUTIME_ID);
    app::advanceFrame(demo, frame == 0 ? 0 : 1.0 / 60, {});
    const double whole = seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    if (frame >= run.warm_up) {
      // The stages' shares of a steady clock, of the time that the thread had.
      const app::FrameStats& stats = demo.stats;
      const double share = stats.whole > 0 ? stats.simulation() / stats.whole : 0;
      simulation.push_back(share * whole);
      character.push_back((1 - share) * whole);
      for (std::size_t s = 0; s < stats.skipped.size(); ++s) {
        done.row.skipped[s].skipped += stats.skipped[s].skipped;
        done.row.skipped[s].of += stats.skipped[s].of;
        done.row.skipped[s].seconds += stats.skipped[s].seconds;
      }
    }
    if (std::find(run.drawn.begin(), run.drawn.end(), frame) == run.drawn.end()) continue;
    std::vector<std::vector<float>>& shown = done.shown.emplace_back();
    for (const app::Actor& actor : demo.actors) shown.push_back(actor.shown_positions);
    for (Picturing* one : picturing) draw(run, demo, *one);
  }
  for (const app::Actor& actor : demo.actors) {
    const double size = actor.haircut->mesh.hair_length + 2 * actor.body->character.scalp.head_height;
    done.metre.push_back(app::projectedSize(demo, actor) / size);
    done.seen.push_back(app::mayBeSeen(demo, actor));
  }
  // Means: steps of a crowd fall into different frames.
  done.row.simulation_ms = 1e3 * mean(simulation);
  done.row.character_ms = 1e3 * mean(character);
  return done;
}

void compareShapes(const Simulated& reference, const Simulated& other, SkipRow& row) {
  for (std::size_t f = 0; f < reference.shown.size(); ++f) {
    for (std::size_t a = 0; a < reference.shown[f].size(); ++a) {
      const std::vector<float>&p = reference.shown[f][a], &q = other.shown[f][a];
      if (!reference.seen[a] || p.size() != q.size() || p.empty()) continue;
      double sum = 0;
      for (std::size_t i = 0; i + 2 < p.size(); i += 3)
        sum += std::hypot(p[i] - q[i], p[i + 1] - q[i + 1], p[i + 2] - q[i + 2]);
      const double mean = 3 * sum / static_cast<double>(p.size());
      row.simulation_error_mm = std::max(row.simulation_error_mm, 1e3 * mean);
      row.simulation_error_pixels = std::max(row.simulation_error_pixels, reference.metre[a] * mean);
    }
  }
}

double imageError(const app::Image& a, const app::Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 != 3) sum += std::abs(static_cast<int>(a.rgba[i]) - static_cast<int>(b.rgba[i]));
  }
  return sum / (0.75 * static_cast<double>(a.rgba.size()));
}

void finish(const std::vector<app::Image>& reference, Picturing& picturing) {
  picturing.row.drawing_ms = 1e3 * median(picturing.seconds);
  for (std::size_t i = 0; i < reference.size(); ++i)
    picturing.row.image_error = std::max(picturing.row.image_error, imageError(reference[i], picturing.images[i]));
}

}  // namespace

std::vector<SkipRow> measureScene(const SceneRun& run, const std::string& folder) {
  std::vector<SkipRow> rows;
  const std::string scene = app::stem(run.file);
  // The drawing skips are shown the frames of the run without any skip.
  std::vector<Picturing> picturing;
  const auto add = [&](const char* name, const app::SkipSet& skips) {
    Picturing& one = picturing.emplace_back();
    one.skips = skips;
    one.row.skips = name;
    one.renderer = std::make_unique<render::Renderer>(app::dataPath("shaders"));
  };
  add("none", none());
  for (const app::Skip& skip : app::skipTable()) {
    if (!isDrawing(skip)) continue;
    app::SkipSet one = none();
    one.on[skip.id] = true;
    add(skip.name, one);
  }
  std::vector<Picturing*> of_none;
  for (Picturing& one : picturing) of_none.push_back(&one);
  const Simulated plain = simulate(run, none(), of_none);
  std::printf("%s: without skips done\n", scene.c_str());
  const std::vector<app::Image> reference = picturing.front().images;
  for (Picturing& one : picturing) {
    finish(reference, one);
    one.row.simulation_ms = plain.row.simulation_ms;
    one.row.character_ms = plain.row.character_ms;
    rows.push_back(one.row);
  }
  app::writePng(folder + "/skipping_" + scene + "_none.png", run.width, run.height, reference.back().rgba);
  const double plain_drawing = rows.front().drawing_ms;
  picturing.clear();

  for (const app::Skip& skip : app::skipTable()) {
    if (isDrawing(skip) || skip.id == app::kSkipEvents) continue;
    app::SkipSet one = none();
    one.on[skip.id] = true;
    Simulated alone = simulate(run, one, {});
    compareShapes(plain, alone, alone.row);
    alone.row.skips = skip.name;
    alone.row.drawing_ms = plain_drawing;
    rows.push_back(alone.row);
  }
  add("all", app::SkipSet{});
  Simulated all = simulate(run, app::SkipSet{}, {&picturing.front()});
  finish(reference, picturing.front());
  SkipRow& row = picturing.front().row;
  for (std::size_t s = 0; s < row.skipped.size(); ++s) {
    if (row.skipped[s].of == 0) row.skipped[s] = all.row.skipped[s];
  }
  row.simulation_ms = all.row.simulation_ms;
  row.character_ms = all.row.character_ms;
  compareShapes(plain, all, row);
  rows.push_back(row);
  app::writePng(folder + "/skipping_" + scene + "_all.png", run.width, run.height,
                picturing.front().images.back().rgba);
  const std::string strands = run.strands > 0 ? std::to_string(run.strands) : "the scene's number of";
  for (SkipRow& one : rows) {
    one.scene = scene;
    one.setup =
        std::to_string(run.width) + "x" + std::to_string(run.height) + " pixels, " + strands + " strands a head";
  }
  return rows;
}

}  // namespace bench
