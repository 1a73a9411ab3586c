#include "tests/bench/styles_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "app/files/data_path.h"
#include "app/files/output_file.h"
#include "app/scene/demo.h"
#include "tests/bench/scene_times.h"

namespace bench {
namespace {

constexpr int kWarmUpFrames = 60;

struct StyleRow {
  std::string name;
  int vertices = 0;
  std::vector<app::FrameStats> frames;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

double medianOf(const StyleRow& row, auto&& value) {
  std::vector<double> values;
  for (const app::FrameStats& frame : row.frames) values.push_back(value(frame));
  return median(std::move(values));
}

double simulationMs(const StyleRow& row) {
  return 1e3 * medianOf(row, [](const app::FrameStats& f) { return f.simulation() + f.seconds[app::kTimeCharacter]; });
}

StyleRow measure(app::Style style, app::Resolution resolution, const StylesOptions& options) {
  app::Scene scene;
  app::CharacterSpec spec;
  spec.motion = app::findFile(options.motion, "", "clips");
  spec.style = style;
  spec.resolution = resolution;
  scene.characters.push_back(spec);
  app::Demo demo = app::openScene(std::move(scene), 16.0 / 9);
  StyleRow row;
  row.name = std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution));
  row.vertices = demo.actors.front().haircut->mesh.vertexCount();
  for (int frame = 0; frame < kWarmUpFrames + options.frames; ++frame) {
    app::advanceFrame(demo, kFrame, {});
    if (frame >= kWarmUpFrames) row.frames.push_back(demo.stats);
  }
  return row;
}

// The paper's published milliseconds (2016, one core of an i7-3930K); zero where it gives none.
double published(app::Style style, app::Resolution resolution) {
  if (resolution == app::Resolution::kLow) return style == app::Style::kShort ? 4.8 : 6.0;
  return style == app::Style::kLong && resolution == app::Resolution::kHigh ? 36.0 : 0.0;
}

// Slope of log time over log vertices, least squares.
double growthExponent(const std::vector<StyleRow>& rows) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const StyleRow& row : rows) {
    const double x = std::log(row.vertices), y = std::log(simulationMs(row));
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

void runStyles(const StylesOptions& options) {
  std::ostringstream table;
  table << "| style | vertices | ms a frame | paper | character | forces | solve | collision | minimization | other | "
           "iterations | contacts |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::vector<StyleRow> rows;
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
      const StyleRow row = measure(style, resolution, options);
      const auto stage = [&](app::FrameStage s) {
        return 1e3 * medianOf(row, [&](const auto& f) { return f.seconds[s]; });
      };
      char line[400], paper[16] = "-";
      if (const double ms = published(style, resolution); ms > 0) std::snprintf(paper, sizeof paper, "%.1f", ms);
      std::snprintf(
          line, sizeof line, "| %s | %d | %.2f | %s | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.0f | %.0f |\n",
          row.name.c_str(), row.vertices, simulationMs(row), paper, stage(app::kTimeCharacter), stage(app::kTimeForces),
          stage(app::kTimeSolve), stage(app::kTimeCollision), stage(app::kTimeMinimization), stage(app::kTimeStepOther),
          medianOf(row, [](const auto& f) { return static_cast<double>(f.solver_iterations); }),
          medianOf(row, [](const auto& f) { return static_cast<double>(f.contacts); }));
      table << line;
      rows.push_back(row);
      std::printf("%s", line);
      std::fflush(stdout);
    }
  }
  char growth[160];
  std::snprintf(growth, sizeof growth, "\nTime grows with the vertex count to the power %.2f.\n", growthExponent(rows));
  table << growth;
  std::printf("%s", growth);
  if (options.table.empty()) return;
  app::writeFile(options.table, table.str());
}

}  // namespace bench
