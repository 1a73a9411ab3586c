#include "tests/bench/asked.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string_view>

#include "app/files/data_path.h"
#include "app/options.h"
#include "tests/bench/draw_scene.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/skipping.h"
#include "tests/bench/trajectory.h"
#include "tests/bench/written_files.h"

namespace bench {
namespace {

using Names = std::vector<std::string>;

bool isAsked(const std::vector<Task>& tasks, std::initializer_list<std::string_view> flags) {
  return std::ranges::any_of(
      tasks, [&](const Task& task) { return task.asked && std::ranges::find(flags, task.flag) != flags.end(); });
}

void addNames(const Names& more, Names& names) {
  for (const std::string& name : more) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
}

void checkNames(const std::string& option, const Names& asked, const Names& known) {
  for (const std::string& name : asked) {
    if (std::ranges::find(known, name) != known.end()) continue;
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    throw app::UsageError(option + ": there is no '" + name + "' in what is measured; choose of " + list);
  }
}

Names namesOfScenes(const auto& scenes) {
  Names names;
  for (const auto& scene : scenes) names.emplace_back(scene.name);
  return names;
}

Names stylesWith(std::initializer_list<app::Resolution> resolutions) {
  Names names;
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    for (const app::Resolution resolution : resolutions)
      names.push_back(std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution)));
  }
  return names;
}

void checkScenes(const std::vector<Task>& tasks, const Asked& asked) {
  Names known;
  if (isAsked(tasks, {"--pareto"})) addNames(namesOfScenes(trajectoryScenes()), known);
  if (isAsked(tasks, {"--draw-pareto"})) addNames(namesOfScenes(drawScenes()), known);
  if (isAsked(tasks, {"--skipping"})) addNames(skippingScenes(), known);
  if (!known.empty()) checkNames("--scenes", asked.pareto.scenes, known);
}

void checkStylesAndClips(const std::vector<Task>& tasks, const Asked& asked) {
  using enum app::Resolution;
  if (isAsked(tasks, {"--skin"})) checkNames("--only", asked.skin.styles, stylesWith({kLow, kMedium, kHigh, kUltra}));
  if (isAsked(tasks, {"--collisions", "--colliders", "--frames-budget"}))
    checkNames("--only", asked.collisions.styles, stylesWith({kLow, kMedium, kHigh}));
  Names known;
  if (isAsked(tasks, {"--frames-budget"})) addNames(framesBudgetClips(), known);
  if (isAsked(tasks, {"--skin"})) addNames(skinClips(), known);
  if (!known.empty()) checkNames("--clips", asked.frames_budget.clips, known);
  if (isAsked(tasks, {"--collisions", "--colliders"})) {
    for (const std::string& clip : asked.collisions.clips) app::findFile(clip, "", "clips");
  }
}

// --skin takes every parameter that hairmesh does, and checks them itself.
void checkSets(const std::vector<Task>& tasks, const Asked& asked) {
  if (!isAsked(tasks, {"--collisions", "--swing"})) return;
  sim::SimParams params;
  for (const auto& [name, value] : asked.swing.sets) {
    const sim::ParamText answer = sim::setParam(params, name, value);
    if (!answer.ok) throw app::UsageError("--set " + name + ": " + answer.fault);
  }
}

void checkPages(const std::vector<Task>& tasks, const Asked& asked) {
  const std::string& out = asked.pareto.folder;
  const auto checkIfThere = [](const std::string& page, const Names& parts) {
    if (std::filesystem::exists(page)) checkMeasuredParts(page, parts);
  };
  if (!asked.accuracy.empty()) checkMeasuredParts(asked.accuracy + "/accuracy.md", {"sweep", "solvers", "peers"});
  if (!asked.performance.empty()) checkMeasuredParts(asked.performance + "/performance.md", {"walk", "start-up"});
  if (isAsked(tasks, {"--gate"}) && !asked.gate_document.empty())
    checkMeasuredParts(asked.gate_document + "/gate.md", {"figures"});
  if (isAsked(tasks, {"--frames-budget"}) && !asked.frames_budget.folder.empty())
    checkMeasuredParts(asked.frames_budget.folder + "/performance.md", {"frames-budget"});
  if (isAsked(tasks, {"--skin"}) && !asked.skin.folder.empty())
    checkMeasuredParts(asked.skin.folder + "/skin.md", {"skin"});
  if (isAsked(tasks, {"--conversion"}) && !asked.conversion.folder.empty())
    checkMeasuredParts(asked.conversion.folder + "/conversion.md", {"kinds"});
  if (isAsked(tasks, {"--consistency"})) checkMeasuredParts(out + "/consistency.md", {"resolutions", "steps"});
  if (isAsked(tasks, {"--collision-document"}))
    checkMeasuredParts(out + "/collision.md", {"clips", "spawn", "crossing", "self", "colliders"});
  if (isAsked(tasks, {"--ladder"})) checkIfThere(out + "/performance.md", {"ladder"});
  if (isAsked(tasks, {"--draw-pareto"})) checkIfThere(out + "/drawing.md", {"draw-scenes", "draw-settings"});
  if (isAsked(tasks, {"--draw-passes"})) checkIfThere(out + "/gpu.md", {"gpu-renderer", "gpu-triangles", "gpu-passes"});
  if (isAsked(tasks, {"--skipping"})) checkIfThere(out + "/skipping.md", {"bounds", "scenes"});
}

// `name`: a file of those that go there, in whose place one is tried.
void checkFolder(const std::string& folder, const char* name, const char* option) {
  checkNewFile(folder + "/" + name, std::string("choose another with ") + option);
}

}  // namespace

void checkAsked(const std::vector<Task>& tasks, const Asked& asked) {
  checkScenes(tasks, asked);
  checkStylesAndClips(tasks, asked);
  checkSets(tasks, asked);
}

void checkOutputs(const std::vector<Task>& tasks, const Asked& asked) {
  checkPages(tasks, asked);
  const std::string &out = asked.pareto.folder, &references = asked.pareto.references;
  const char* place = asked.accuracy.empty() ? "--out" : "--accuracy";
  if (isAsked(tasks, {"--pareto"})) checkFolder(out, "pareto.csv", place);
  if (isAsked(tasks, {"--solvers"})) checkFolder(out, "solvers.csv", place);
  if (isAsked(tasks, {"--peers"})) checkFolder(out, "peers.json", place);
  if (isAsked(tasks, {"--draw-pareto"})) checkFolder(out + "/data", "draw_pareto.csv", place);
  if (isAsked(tasks, {"--draw-passes"})) checkFolder(out + "/data", "gpu_passes.csv", place);
  if (isAsked(tasks, {"--skipping"})) checkFolder(out + "/data", "skipping.csv", place);
  if (isAsked(tasks, {"--collision-document"})) checkFolder(out + "/data", "collision_clips.csv", place);
  if (isAsked(tasks, {"--pareto", "--gate"}) && !references.empty())
    checkFolder(references, "head_shake.bin", "--references");
  if (isAsked(tasks, {"--styles"}) && !asked.styles.table.empty()) app::checkWritable(asked.styles.table);
  if (isAsked(tasks, {"--frames-budget"}) && !asked.frames_budget.steps.empty())
    app::checkWritable(asked.frames_budget.steps);
  if (!asked.performance.empty()) checkFolder(asked.performance + "/data", "stages.csv", "--performance-document");
  if (!asked.sheet.folder.empty()) checkFolder(asked.sheet.folder, "styles_short.png", "--contact-sheet");
}

}  // namespace bench
