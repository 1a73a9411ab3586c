#include "tests/bench/skipping_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "app/data_path.h"
#include "app/demo.h"
#include "app/level_of_detail.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

// Pixels: the simulation takes the care that a picture of this height asks for, however small the measured ones are.
constexpr int kSeenHeight = 720;

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
  app::Demo demo = app::openScene(std::move(scene), static_cast<double>(run.width) / run.height);
  demo.picture_height = kSeenHeight;
  Simulated done;
  std::vector<double> simulation, character;
  for (int frame = 0; frame < run.frames; ++frame) {
    const double start = cpuSeconds();
    app::advanceFrame(demo, frame == 0 ? 0 : 1.0 / 60, {});
    const double whole = cpuSeconds() - start;
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
  const auto pictures = [&] {
    std::vector<Picturing*> all;
    for (Picturing& one : picturing) all.push_back(&one);
    return all;
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
  const Simulated all = simulate(run, app::SkipSet{}, pictures());
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
  add("none", none());
  for (const app::Skip& skip : app::skipTable()) {
    if (!isDrawing(skip) || last.skipped[skip.id].skipped == 0) continue;
    app::SkipSet one = none();
    one.on[skip.id] = true;
    add(skip.name, one);
  }
  const Simulated plain = simulate(run, none(), pictures());
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
    app::SkipSet one = none();
    one.on[skip.id] = true;
    Simulated alone = simulate(run, one, {});
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
