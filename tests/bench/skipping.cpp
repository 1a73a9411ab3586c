#include "tests/bench/skipping.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/files/data_path.h"
#include "app/platform/egl_context.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/skipping_document.h"
#include "tests/bench/skipping_simulation.h"
#include "tests/bench/table.h"
#include "tests/bench/written_files.h"

namespace bench {
namespace {

std::vector<SceneRun> sceneRuns(const SkippingOptions& options) {
  const bool quick = options.quick;
  const int width = quick ? 256 : 640, height = quick ? 144 : 360;
  const int near = quick ? 3000 : 10000;  // strands
  const std::vector<int> few = quick ? std::vector{20, 21, 34, 35} : std::vector{20, 21, 22, 34, 35, 36};
  const std::vector<int> two{24, 25};
  // Still hair needs a second to be told from slow hair.
  std::vector<SceneRun> runs{
      {"still_close_up.json", 180, 120, {150, 151, 152, 153, 154}, width, height, near, 0, 0},
      {"short_shake.json", quick ? 40 : 60, 10, few, width, height, near, 0, 0},
      {"walk.json", quick ? 40 : 60, 10, few, width, height, near, 0, 0},
      {"ten_in_a_row.json", quick ? 36 : 48, 12, two, width, height, quick ? 1000 : 10000, 256, near},
      {"crowd.json", quick ? 28 : 40, 12, two, width, height, quick ? 500 : 4000, 128, near},
  };
  if (!options.scenes.empty()) {
    std::erase_if(runs, [&](const SceneRun& run) {
      return std::find(options.scenes.begin(), options.scenes.end(), run.file.substr(0, run.file.find('.'))) ==
             options.scenes.end();
    });
  }
  return runs;
}

nlohmann::json asJson(const SkipRow& row) {
  nlohmann::json skipped = nlohmann::json::object();
  for (const app::Skip& skip : app::skipTable()) {
    const app::SkipCount& count = row.skipped[skip.id];
    if (count.of > 0) skipped[skip.name] = {{"skipped", count.skipped}, {"of", count.of}};
  }
  return {{"scene", row.scene},
          {"skips", row.skips},
          {"setup", row.setup},
          {"simulation_ms", row.simulation_ms},
          {"character_ms", row.character_ms},
          {"drawing_ms", row.drawing_ms},
          {"drawing_like_close_up_ms", row.drawing_like_close_up_ms},
          {"simulation_error_mm", row.simulation_error_mm},
          {"simulation_error_pixels", row.simulation_error_pixels},
          {"image_error", row.image_error},
          {"gpu_bytes_hair", row.gpu_bytes_hair},
          {"gpu_bytes_shadows", row.gpu_bytes_shadows},
          {"skipped", skipped}};
}

SkipRow fromJson(const nlohmann::json& json) {
  SkipRow row;
  row.scene = json.at("scene");
  row.skips = json.at("skips");
  row.setup = json.at("setup");
  row.simulation_ms = json.at("simulation_ms");
  row.character_ms = json.at("character_ms");
  row.drawing_ms = json.at("drawing_ms");
  row.drawing_like_close_up_ms = json.value("drawing_like_close_up_ms", 0.0);
  row.simulation_error_mm = json.at("simulation_error_mm");
  row.simulation_error_pixels = json.at("simulation_error_pixels");
  row.image_error = json.at("image_error");
  row.gpu_bytes_hair = json.at("gpu_bytes_hair");
  row.gpu_bytes_shadows = json.at("gpu_bytes_shadows");
  for (const auto& [name, count] : json.at("skipped").items()) {
    if (const app::Skip* skip = app::findSkip(name)) row.skipped[skip->id] = {count.at("skipped"), count.at("of"), 0};
  }
  return row;
}

// The scenes that were measured before, without those of `runs`.
SkipScenes measuredBefore(const std::string& file, const std::vector<SceneRun>& runs) {
  SkipScenes scenes;
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(file), nullptr, false);
  if (!json.is_array()) return scenes;
  for (const nlohmann::json& entry : json) {
    const SkipRow row = fromJson(entry);
    const auto again = [&](const SceneRun& run) { return app::stem(run.file) == row.scene; };
    if (std::any_of(runs.begin(), runs.end(), again)) continue;
    if (scenes.empty() || scenes.back().front().scene != row.scene) scenes.emplace_back();
    scenes.back().push_back(row);
  }
  return scenes;
}

SceneRun simulationOf(const char* file, int frames, int warm_up) {
  SceneRun run;
  run.file = file;
  run.frames = frames;
  run.warm_up = warm_up;
  run.width = 256, run.height = 144;
  return run;
}

}  // namespace

std::vector<std::string> skippingScenes() {
  std::vector<std::string> names;
  for (const SceneRun& run : sceneRuns({})) names.push_back(app::stem(run.file));
  return names;
}

bool runCrowd(int rounds) {
  const SceneRun close = simulationOf("walk.json", 40, 10), crowd_run = simulationOf("crowd.json", 28, 12);
  std::vector<double> ratios, crowd_ms, character_ms, close_ms;
  for (int round = 0; round < rounds; ++round) {
    // The close-up before and after, for what else the machine does comes and goes.
    const double before = simulate(close, app::SkipSet{}).row.simulation_ms;
    const SkipRow crowd = simulate(crowd_run, app::SkipSet{}).row;
    const double after = simulate(close, app::SkipSet{}).row.simulation_ms;
    close_ms.push_back(0.5 * (before + after));
    crowd_ms.push_back(crowd.simulation_ms);
    character_ms.push_back(crowd.character_ms);
    ratios.push_back(crowd_ms.back() / close_ms.back());
  }
  const double ratio = medianOf(ratios);
  std::printf("close-up %.2f ms, crowd %.2f ms (and %.2f of character): %s\n", medianOf(close_ms), medianOf(crowd_ms),
              medianOf(character_ms), boundText({"crowd over close-up", ratio, kCrowdRatio}).c_str());

  // The frames of runSkipping, which are held to the bound; and the first second, in which long hair that a shoulder
  // turns aside begins to go another way with whatever is changed.
  SceneRun half = crowd_run, second = simulationOf("crowd.json", 62, 12);
  half.drawn = {24, 25};
  for (int frame = 2; frame < second.frames; ++frame) second.drawn.push_back(frame);
  const Simulated half_truth = simulate(half, noSkips()), second_truth = simulate(second, noSkips());
  double worst = 0;
  for (const std::string name : {"far-steps", "far-mesh", "all"}) {
    app::SkipSet skips;
    if (const app::Skip* skip = app::findSkip(name)) {
      skips = noSkips();
      skips.on[skip->id] = true;
    }
    SkipRow held, later;
    compareShapes(half_truth, simulate(half, skips), held);
    compareShapes(second_truth, simulate(second, skips), later);
    worst = std::max(worst, held.simulation_error_pixels);
    std::printf("%s: shapes off by %.1f mm, %s; within the first second by %.1f mm, %.2f pixels\n", name.c_str(),
                held.simulation_error_mm, boundText({"pixels", held.simulation_error_pixels, kShapePixels}).c_str(),
                later.simulation_error_mm, later.simulation_error_pixels);
  }
  return ratio <= kCrowdRatio && worst <= kShapePixels;
}

bool runSkipping(const SkippingOptions& options) {
  makeFolder(options.folder, "choose another with --out");
  startSkipDocument(options.folder);
  const std::string data = dataFolder(options.folder);
  app::EglContext context;
  const std::string file = data + "/skipping.json";
  const std::vector<SceneRun> runs = sceneRuns(options);
  SkipScenes scenes = measuredBefore(file, runs);
  for (const SceneRun& run : runs) {
    scenes.push_back(measureScene(run, data));
    std::printf("%s\n%s\n", run.file.c_str(), skipTableOf(scenes.back()).c_str());
    std::fflush(stdout);
  }
  // In the order of the list, whichever were measured now.
  SkippingOptions every;
  const std::vector<SceneRun> order = sceneRuns(every);
  const auto place = [&](const std::vector<SkipRow>& rows) {
    return std::find_if(order.begin(), order.end(),
                        [&](const SceneRun& run) { return app::stem(run.file) == rows.front().scene; });
  };
  std::sort(scenes.begin(), scenes.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  nlohmann::json json = nlohmann::json::array();
  for (const std::vector<SkipRow>& rows : scenes) {
    plotSkips(rows, data);
    for (const SkipRow& row : rows) json.push_back(asJson(row));
  }
  app::writeFile(file, json.dump(1) + "\n");
  const std::vector<SkipBound> held = skipBounds(scenes);
  for (const SkipBound& bound : held) std::printf("%s\n", boundText(bound).c_str());
  writeSkipDocument(scenes, held, options.folder);
  return std::all_of(held.begin(), held.end(), [](const SkipBound& bound) { return bound.holds(); });
}

}  // namespace bench
