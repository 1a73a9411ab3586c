#include "tests/bench/frames_budget.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>

#include "app/files/data_path.h"
#include "app/files/errors.h"
#include "app/scene/actor.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/gnuplot.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/preset_params.h"
#include "tests/bench/table.h"
#include "tests/bench/written_files.h"
#include "tests/sim_probes.h"

namespace bench {
namespace {

namespace fs = std::filesystem;

constexpr double kBefore = 1, kShortest = 4, kLongest = 60;  // s
constexpr double kRounds = 2;
constexpr double kStep = 1.0 / 60;  // s

struct ClipFile {
  std::string file, parts, name;
};

struct StepCost {
  double units = 0, seconds = 0;
  sim::StepWork work;
};

struct Costs {
  std::vector<StepCost> steps;
  double depth = 0;  // m, of the deepest external vertex after a step
  int guided = 0;    // columns, summed over steps
};

// Walk first: the others are measured against it. `missing` gets the folders that are not there.
std::vector<ClipFile> allClips(std::vector<std::string>& missing) {
  std::vector<ClipFile> found;
  const std::string walk = app::findFile("walk.bvh", "", "clips");
  const fs::path own = fs::path(walk).parent_path(), shared = own / ".." / ".." / ".." / "shared";
  std::vector<fs::path> files;
  for (const fs::path& folder : {own, shared / "mocap", shared / "arcsim"}) {
    if (!fs::exists(folder)) {
      missing.push_back(folder.filename().string());
      continue;
    }
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    if (file.extension() == ".mot")
      found.push_back({file.string(), (file.parent_path() / "female-objs").string(), name});
    if (file.extension() == ".bvh" && name != "walk.bvh") found.push_back({file.string(), "", name});
  }
  found.insert(found.begin(), {walk, "", "walk.bvh"});
  return found;
}

std::vector<ClipFile> clipsOf(const FramesBudgetOptions& options) {
  std::vector<std::string> missing;
  std::vector<ClipFile> clips = allClips(missing);
  for (const std::string& folder : missing) std::printf("%s is not there: its clips are left out\n", folder.c_str());
  std::erase_if(clips, [&](const ClipFile& clip) {
    return !options.clips.empty() && clip.name != "walk.bvh" &&
           std::ranges::find(options.clips, clip.name) == options.clips.end();
  });
  return clips;
}

double deepest(const app::Actor& actor) {
  double depth = 0;
  for (const int v : actor.haircut->mesh.external_vertices) {
    const sim::Vec3& x = actor.hair.positions[v];
    for (const sim::Ellipsoid& e : actor.ellipsoids) {
      if (test::implicitValue(e, x) < 0) depth = std::max(depth, -sim::closestPoint(e, x).distance);
    }
  }
  return depth;
}

Costs play(const sim::SimParams& params, double speed, app::Actor& actor) {
  app::placeActor(actor, true);
  app::settleActor(params, kBefore, actor);
  actor.playback.speed = speed;
  const double seconds = std::clamp(kRounds * actor.playedClip().duration() / speed, kShortest, kLongest);
  Costs costs;
  for (int step = 1; step <= static_cast<int>(seconds / kStep); ++step) {
    app::moveActor(kStep, actor);
    const double started = cpuSeconds();
    const sim::StepReport report = app::simulateActor(params, kStep, step * kStep, actor);
    const double took = cpuSeconds() - started;
    costs.steps.push_back({report.work_units, took, report.work});
    costs.guided += report.guided;
    costs.depth = std::max(costs.depth, deepest(actor));
  }
  return costs;
}

// The value that a share of the steps does not exceed.
double quantile(const std::vector<StepCost>& steps, double share, double StepCost::*of) {
  std::vector<double> values;
  for (const StepCost& step : steps) values.push_back(step.*of);
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

const std::vector<std::string> kBudgetHead{"style", "clip",  "speed",    "median",     "p99",     "p99.9",
                                           "worst", "holds", "p99 time", "worst time", "mm deep", "guided"};

struct Measured {
  Table table{kBudgetHead, {}};
  std::vector<Series> shares;  // of steps that cost at least so much
  bool all_hold = true;
};

// A row of what a clip costs over the walk's medians.
void addRow(const std::string& style, const std::string& clip, double speed, const Costs& costs, const StepCost& walk,
            Measured& measured) {
  const auto over = [&](double share) { return quantile(costs.steps, share, &StepCost::units) / walk.units; };
  const auto time = [&](double share) { return quantile(costs.steps, share, &StepCost::seconds) / walk.seconds; };
  const bool holds = over(0.99) <= (speed > 1 ? 6 : 3) && over(1) <= (speed > 1 ? 12 : 8);
  measured.all_hold = measured.all_hold && holds;
  measured.table.rows.push_back(
      {style, clip, formatted("%g", speed), formatted("%.2f", over(0.5)), formatted("%.2f", over(0.99)),
       formatted("%.2f", over(0.999)), formatted("%.2f", over(1)), holds ? "yes" : "no", formatted("%.1f", time(0.99)),
       formatted("%.1f", time(1)), formatted("%.2f", 1e3 * costs.depth), formatted("%d", costs.guided)});
  const auto& row = measured.table.rows.back();
  for (const std::string& cell : row) std::printf("%s%s", cell.c_str(), &cell == &row.back() ? "\n" : ", ");
  std::fflush(stdout);
}

void addShares(const std::string& title, std::vector<double> costs, Measured& measured) {
  std::sort(costs.begin(), costs.end());
  Series series{title, "lines lw 2", {}};
  for (double cost = 0.5; cost < 40; cost *= 1.05) {
    const auto above = costs.end() - std::lower_bound(costs.begin(), costs.end(), cost);
    if (above > 0) series.points.push_back({cost, static_cast<double>(above) / static_cast<double>(costs.size())});
  }
  measured.shares.push_back(series);
}

void writeSteps(const std::string& style, const std::string& clip, double speed, int vertices, const Costs& costs,
                RowFile& file) {
  std::ostringstream out;
  for (const StepCost& s : costs.steps) {
    out << style << "," << clip << "," << speed << "," << vertices << "," << s.work.solves << "," << s.work.iterations
        << "," << s.work.factors << "," << s.work.coarse_spaces << "," << s.work.energies << "," << s.work.minimizations
        << "," << s.work.surface_points << "," << 1e6 * s.seconds << "\n";
  }
  file.add(out.str());
}

// Of each style, one row: for every speed the largest p99 and the largest worst cost over the clips, the clip of the
// latter, and how many clips hold.
Table worstClips(const Table& all, const std::vector<double>& speeds) {
  Table worst{{"style"}, {}};
  for (const double speed : speeds) {
    for (const char* what : {"p99 / worst", "clip"}) worst.head.push_back(formatted("%gx: %s", speed, what));
  }
  worst.head.emplace_back("hold");
  std::vector<std::string> styles;
  for (const auto& row : all.rows) {
    if (styles.empty() || styles.back() != row[0]) styles.push_back(row[0]);
  }
  for (const std::string& style : styles) {
    std::vector<std::string> cells{style};
    int hold = 0, count = 0;
    for (const double speed : speeds) {
      double p99 = 0, most = 0;
      std::string clip;
      for (const auto& row : rowsWith(rowsWith(all, "style", style), "speed", formatted("%g", speed)).rows) {
        p99 = std::max(p99, std::stod(row[4]));
        if (std::stod(row[6]) > most) most = std::stod(row[6]), clip = row[1].substr(0, row[1].find('.'));
        hold += row[7] == "yes", ++count;
      }
      cells.push_back(formatted("%.1f / %.1f", p99, most));
      cells.push_back(clip);
    }
    cells.push_back(formatted("%d of %d", hold, count));
    worst.rows.push_back(cells);
  }
  return worst;
}

void writeDocument(const std::string& folder, const std::vector<double>& speeds, const Measured& measured) {
  writeTable(folder, "frames-budget", measured.table);
  writeMeasuredPart(folder + "/performance.md", "frames-budget", worstClips(measured.table, speeds).markdown());
  drawChart(dataFolder(folder), "frames-budget",
            {"Steps of all clips that cost at least so much", "cost over the median step of a walk",
             "share of the steps", measured.shares});
}

app::Actor actorOf(const ClipFile& clip, app::Style style, app::Resolution resolution, app::AssetCache& cache) {
  app::CharacterSpec spec;
  spec.motion = clip.file;
  spec.parts = clip.parts;
  spec.style = style;
  spec.resolution = resolution;
  return app::makeActor(spec, {}, cache);
}

void measureStyle(app::Style style, app::Resolution resolution, const std::vector<ClipFile>& clips,
                  const std::vector<double>& speeds, RowFile& steps, Measured& measured) {
  const std::string name = std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution));
  const sim::SimParams params = presetParams(kOpened);
  app::AssetCache cache;
  StepCost walk;
  std::vector<std::vector<double>> all(speeds.size());
  for (const ClipFile& clip : clips) {
    app::Actor actor = actorOf(clip, style, resolution, cache);
    const int vertices = actor.haircut->mesh.vertexCount();
    if (clip.name == "walk.bvh") {
      const Costs costs = play(params, 1, actor);
      walk = {quantile(costs.steps, 0.5, &StepCost::units), quantile(costs.steps, 0.5, &StepCost::seconds), {}};
    }
    for (std::size_t s = 0; s < speeds.size(); ++s) {
      const Costs costs = play(params, speeds[s], actor);
      addRow(name, clip.name, speeds[s], costs, walk, measured);
      for (const StepCost& step : costs.steps) all[s].push_back(step.units / walk.units);
      if (steps.wanted()) writeSteps(name, clip.name, speeds[s], vertices, costs, steps);
    }
  }
  for (std::size_t s = 0; s < speeds.size(); ++s)
    addShares(formatted("%s, %gx", name.c_str(), speeds[s]), std::move(all[s]), measured);
}

}  // namespace

std::vector<std::string> framesBudgetClips() {
  std::vector<std::string> missing, names;
  for (const ClipFile& clip : allClips(missing)) names.push_back(clip.name);
  return names;
}

bool runFramesBudget(const FramesBudgetOptions& options) {
  const std::vector<ClipFile> clips = clipsOf(options);
  const std::vector<double> speeds = options.speeds.empty() ? std::vector<double>{1, 4, 10, 20} : options.speeds;
  RowFile steps(options.steps,
                "style,clip,speed,vertices,solves,iterations,factors,coarse_spaces,energies,minimizations,"
                "surface_points,microseconds\n");
  Measured measured;
  for (const std::string& cell : kBudgetHead)
    std::printf("%s%s", cell.c_str(), &cell == &kBudgetHead.back() ? "\n" : ", ");
  for (const app::Style style : {app::Style::kShort, app::Style::kShoulder, app::Style::kLong}) {
    for (const app::Resolution resolution : {app::Resolution::kLow, app::Resolution::kMedium, app::Resolution::kHigh}) {
      const std::string name = std::string(app::styleName(style)) + " " + std::string(app::resolutionName(resolution));
      if (options.styles.empty() || std::ranges::find(options.styles, name) != options.styles.end())
        measureStyle(style, resolution, clips, speeds, steps, measured);
    }
  }
  if (measured.table.rows.empty()) throw app::InputError("", "--only", "names no style", "such as 'long low'");
  if (!options.folder.empty()) writeDocument(options.folder, speeds, measured);
  return measured.all_hold;
}

}  // namespace bench
