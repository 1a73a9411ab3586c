#include "tests/bench/skipping_simulation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/files/data_path.h"
#include "app/scene/detail/level_of_detail.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

// Pixels: the simulation takes the care that a picture of this height asks for, however small the measured ones are.
constexpr int kSeenHeight = 720;

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

}  // namespace

app::SkipSet noSkips() {
  app::SkipSet skips;
  skips.on.fill(false);
  return skips;
}

Simulated simulate(const SceneRun& run, const app::SkipSet& skips, const std::function<void(app::Demo&)>& draw) {
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
    if (draw) draw(demo);
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

}  // namespace bench
