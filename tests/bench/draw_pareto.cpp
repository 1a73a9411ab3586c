#include "tests/bench/draw_pareto.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "app/files/data_path.h"
#include "app/platform/egl_context.h"
#include "render/gl/driver.h"
#include "tests/bench/draw_sweep.h"
#include "tests/bench/gnuplot.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"

namespace bench {
namespace {

constexpr const char* kPointsName = "draw_pareto";
constexpr const char* kScenesName = "draw_scenes";
constexpr const char* kSettingsName = "draw_settings";
constexpr int kConfirmingRounds = 5;  // of the fastest setting and the default, in turns

Table pointTable(const DrawSweep& sweep) {
  Table table{
      {"scene", "setting", "ms", "processor ms", "least", "error", "error of blocks", "strands", "front", "no worse"},
      {}};
  const DrawPoint& standard = sweep.points.front();
  for (const DrawPoint& point : sweep.points) {
    table.rows.push_back({sweep.scene.name, point.setting.name(), formatted("%.1f", point.wall),
                          formatted("%.1f", point.processor), formatted("%.1f", point.time),
                          formatted("%.3f", point.error.rms), formatted("%.3f", point.error.blocks),
                          std::to_string(point.strands), point.on_front ? "yes" : "no",
                          noWorse(point.error, standard.error, sweep.reference.own) ? "yes" : "no"});
  }
  return table;
}

Table sceneTable(const DrawSweep& sweep, const DrawLag& lag) {
  const DrawPoint& standard = sweep.points.front();
  return {
      {"scene", "picture", "default: ms", "processor ms", "error", "of blocks", "reference's own", "of blocks, own",
       "fastest with no more error", "times faster"},
      {{sweep.scene.name, formatted("%dx%d", sweep.scene.width, sweep.scene.height), formatted("%.0f", standard.wall),
        formatted("%.0f", standard.processor), formatted("%.2f", standard.error.rms),
        formatted("%.2f", standard.error.blocks), formatted("%.2f", sweep.reference.own.rms),
        formatted("%.2f", sweep.reference.own.blocks), lag.point->setting.name(), formatted("%.2f", lag.ratio)}}};
}

Table readTable(const std::string& folder, const char* name) {
  std::ifstream stream(dataFolder(folder) + "/" + name + ".csv");
  return tableOfCsv({std::istreambuf_iterator<char>(stream), {}});
}

// The rows of `before` in the order of the scenes, with those of a scene replaced by its new ones.
Table withScenes(const Table& before, const std::map<std::string, Table>& measured) {
  Table all;
  for (const DrawScene& scene : drawScenes()) {
    const auto fresh = measured.find(scene.name);
    if (fresh != measured.end())
      append(fresh->second, all);
    else if (!before.rows.empty())
      append(rowsWith(before, "scene", scene.name), all);
  }
  return all;
}

// What each setting costs and strays against the default: geometric means over the scenes.
Table settingTable(const Table& points) {
  struct Means {
    double time = 0, error = 0, blocks = 0;
    int scenes = 0;
  };
  const Table some = columns(points, {"scene", "setting", "least", "error", "error of blocks"});
  std::vector<std::string> order;
  std::map<std::string, Means> means;
  const std::vector<std::string>* standard = nullptr;
  for (const auto& row : some.rows) {
    if (standard == nullptr || (*standard)[0] != row[0]) standard = &row;  // a scene's first row
    if (!means.contains(row[1])) order.push_back(row[1]);
    Means& mean = means[row[1]];
    const auto ratio = [&](std::size_t k) {
      return std::log(std::atof(row[k].c_str()) / std::atof((*standard)[k].c_str()));
    };
    mean.time += ratio(2), mean.error += ratio(3), mean.blocks += ratio(4);
    ++mean.scenes;
  }
  Table table{{"setting", "time", "error", "error of blocks", "scenes"}, {}};
  for (const std::string& name : order) {
    const Means& mean = means[name];
    const auto text = [&](double sum) { return formatted("%.2f", std::exp(sum / mean.scenes)); };
    table.rows.push_back({name, text(mean.time), text(mean.error), text(mean.blocks), std::to_string(mean.scenes)});
  }
  return table;
}

Chart chartOf(const DrawSweep& sweep) {
  Chart chart{std::string(sweep.scene.name) + ", " + std::to_string(sweep.scene.width) + " x " +
                  std::to_string(sweep.scene.height),
              render::rasterizesInSoftware() ? "ms of the processor a frame" : "ms a frame",
              "RMS error of the picture, levels of 255",
              {}};
  std::vector<const DrawPoint*> sorted;
  for (const DrawPoint& p : sweep.points) sorted.push_back(&p);
  std::ranges::sort(sorted, {}, &DrawPoint::time);
  const auto add = [&](const char* title, const char* style, auto&& chosen) {
    Series series{title, style, {}};
    for (const DrawPoint* p : sorted) {
      if (chosen(*p)) series.points.emplace_back(p->time, p->error.rms);
    }
    chart.series.push_back(std::move(series));
  };
  const auto changes = [](std::initializer_list<std::string> names) {
    return [names = std::vector<std::string>(names)](const DrawPoint& p) {
      return p.setting.changes.size() == 1 && std::ranges::find(names, p.setting.changes[0].first) != names.end();
    };
  };
  add("strands", "points pt 4 ps 0.9", changes({"strands", "strands_per_pixel"}));
  add("segments", "points pt 6 ps 0.9", changes({"segments_per_layer", "segment_error"}));
  add("samples", "points pt 8 ps 0.9", changes({"samples"}));
  add("shadow maps", "points pt 10 ps 0.9", changes({"shadow_size", "opacity_layers"}));
  add("shadow strands", "points pt 12 ps 0.9", changes({"shadow_strands", "shadow_strands_per_pixel"}));
  add("path", "points pt 2 ps 0.9", changes({"strand_path"}));
  add("several at once", "points pt 1 ps 0.9", [](const DrawPoint& p) { return p.setting.changes.size() > 1; });
  add("front", "steps lw 2 lc rgb 'black'", [](const DrawPoint& p) { return p.on_front; });
  add("default", "points pt 3 ps 2.6 lw 2 lc rgb 'red'", [](const DrawPoint& p) { return p.setting.isDefault(); });
  return chart;
}

void print(const DrawSweep& sweep, const DrawLag& lag) {
  std::printf("\n%s, %dx%d: the reference's own error is %.2f levels, %.2f of blocks\n", sweep.scene.name,
              sweep.scene.width, sweep.scene.height, sweep.reference.own.rms, sweep.reference.own.blocks);
  for (const DrawPoint& p : sweep.points) {
    std::printf("%s %-96s %8.1f ms (processor %8.1f)  rms %6.3f  blocks %6.3f\n", p.on_front ? "*" : " ",
                p.setting.name().c_str(), p.wall, p.processor, p.error.rms, p.error.blocks);
  }
  std::printf("  the fastest setting with no more error than the default is %.2f times faster: %s\n", lag.ratio,
              lag.point->setting.name().c_str());
  std::fflush(stdout);
}

void writeTables(const std::string& folder, const std::map<std::string, Table>& points,
                 const std::map<std::string, Table>& scenes) {
  const Table all = withScenes(readTable(folder, kPointsName), points);
  const Table of_scenes = withScenes(readTable(folder, kScenesName), scenes);
  const Table settings = settingTable(all);
  writeTable(folder, kPointsName, all);
  writeTable(folder, kScenesName, of_scenes);
  writeTable(folder, kSettingsName, settings);
  const std::string page = folder + "/drawing.md";
  if (!std::filesystem::exists(page)) return;
  writeMeasuredPart(page, "draw-scenes", of_scenes.markdown());
  writeMeasuredPart(page, "draw-settings", settings.markdown());
}

}  // namespace

void runDrawPareto(const DrawParetoOptions& options) {
  app::EglContext context;
  render::Renderer renderer(app::dataPath("shaders"));
  std::map<std::string, Table> points, scenes;
  for (const DrawScene& scene : drawScenes()) {
    if (!options.scenes.empty() && !std::count(options.scenes.begin(), options.scenes.end(), scene.name)) continue;
    DrawStage stage(scene, renderer);
    const DrawSweep sweep = sweepDrawing(stage, settingsToDraw(options.quick), options.runs);
    const DrawLag lag = confirmedLag(stage, sweep, std::max(kConfirmingRounds, options.runs));
    print(sweep, lag);
    points[scene.name] = pointTable(sweep);
    scenes[scene.name] = sceneTable(sweep, lag);
    drawChart(dataFolder(options.folder), std::string("draw_") + scene.name, chartOf(sweep));
    // After each scene: a sweep cut short leaves what it has measured.
    writeTables(options.folder, points, scenes);
  }
}

}  // namespace bench
