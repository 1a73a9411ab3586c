#include "tests/bench/performance.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <sstream>

#include "app/files/output_file.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/gnuplot.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"
#include "tests/bench/timed_scene.h"
#include "tests/bench/waits.h"

namespace bench {
namespace {

using app::Resolution;
using app::Style;
using sim::SimParams;

constexpr double kSceneSeconds = 0.5;  // of each scene

// Who simulates.
struct Contender {
  const char* name;
  sim::Solver solver;
  Method method;
  Resolution finest;  // it is run on: the plain implementation takes seconds a frame on finer ones
};
constexpr Contender kContenders[] = {
    {"default", sim::Solver::kDefault, Method::kSimulator, Resolution::kUltra},
    {"--solver paper", sim::Solver::kPaper, Method::kSimulator, Resolution::kUltra},
    {"plain implementation", sim::Solver::kDefault, Method::kPlain, Resolution::kHigh},
};

struct Motion {
  const char *name, *file;
  bool collide;
};
constexpr Motion kMotions[] = {{"walk, with contacts", "walk.bvh", true},
                               {"head shake, without", "head_shake.bvh", false}};

struct StageRow {
  const char* contender;
  const char* motion;
  std::string style, resolution;
  int vertices = 0, iterations = 0, contacts = 0;
  double total = 0, character = 0;                // ms, medians over frames
  std::array<double, sim::kStageCount> stages{};  // ms, means: a stage that seldom runs still counts
};

StageRow rowOf(const TimedRun& run) {
  StageRow row;
  std::vector<double> character, iterations, contacts;
  for (const TimedFrame& frame : run.frames) {
    character.push_back(frame.character);
    iterations.push_back(frame.iterations);
    contacts.push_back(frame.contacts);
    for (int s = 0; s < sim::kStageCount; ++s) {
      row.stages[s] += 1e3 * frame.stages[s] / static_cast<double>(run.frames.size());
    }
  }
  row.total = 1e3 * run.median();
  row.character = 1e3 * medianOf(character);
  row.iterations = static_cast<int>(medianOf(iterations));
  row.contacts = static_cast<int>(medianOf(contacts));
  return row;
}

std::vector<StageRow> measureStages() {
  std::vector<StageRow> rows;
  for (const Motion& motion : kMotions) {
    for (const Style style : {Style::kShort, Style::kShoulder, Style::kLong}) {
      for (const Resolution resolution :
           {Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra}) {
        TimedScene scene(motion.file, style, resolution, motion.collide);
        for (const Contender& contender : kContenders) {
          if (resolution > contender.finest) continue;
          SimParams params;
          params.solver = contender.solver;
          if (contender.solver == sim::Solver::kPaper) params.max_iterations = 400;
          // The first run makes what the others keep: force model, factors, memory.
          const double seconds = contender.method == Method::kPlain ? kSceneSeconds / 4 : kSceneSeconds;
          scene.run(params, seconds, contender.method);
          StageRow row = rowOf(scene.run(params, seconds, contender.method));
          row.contender = contender.name, row.motion = motion.name;
          row.style = app::styleName(style), row.resolution = app::resolutionName(resolution);
          row.vertices = scene.mesh().vertexCount();
          std::printf("%-22s %-20s %-8s %-6s %6d vertices %9.3f ms\n", row.contender, row.motion, row.style.c_str(),
                      row.resolution.c_str(), row.vertices, row.total);
          std::fflush(stdout);
          rows.push_back(std::move(row));
        }
      }
    }
  }
  return rows;
}

Table stageTable(const std::vector<StageRow>& rows) {
  Table table{{"contender", "scene", "style", "vertices", "ms a frame", "forces", "solve", "collision", "minimization",
               "other", "character", "iterations", "contacts"},
              {}};
  for (const StageRow& row : rows) {
    table.rows.push_back({row.contender, row.motion, row.style + " " + row.resolution, std::to_string(row.vertices),
                          formatted("%.3f", row.total)});
    std::vector<std::string>& cells = table.rows.back();
    for (const double ms : row.stages) cells.push_back(formatted("%.3f", ms));
    cells.insert(cells.end(),
                 {formatted("%.3f", row.character), std::to_string(row.iterations), std::to_string(row.contacts)});
  }
  return table;
}

// A frame of a walk by every contender, and the default's stages.
Table walkTable(const Table& stages) {
  const Table walk = rowsWith(stages, "scene", kMotions[0].name);
  Table table = columns(rowsWith(walk, "contender", kContenders[0].name), {"style", "vertices"});
  for (const Contender& contender : kContenders) {
    Table frame = columns(rowsWith(walk, "contender", contender.name), {"style", "ms a frame"});
    frame.head.back() = contender.name;
    table = joined(table, frame, "style");
  }
  const Table ours = columns(rowsWith(walk, "contender", kContenders[0].name),
                             {"style", "forces", "solve", "collision", "minimization", "other", "iterations"});
  return joined(table, ours, "style");
}

std::string startUpTable() {
  std::string out =
      "| style | parse, s | build, s | first step with factor, s | character, style and mesh grown, s "
      "|\n|---|---|---|---|---|\n";
  for (const Style style : {Style::kShoulder, Style::kLong}) {
    for (const Resolution resolution : {Resolution::kLow, Resolution::kHigh, Resolution::kUltra}) {
      const StartUp times = measureStartUp(style, resolution);
      out += formatted("| %s %s | %.3f | %.3f | %.3f | %.3f |\n", std::string(app::styleName(style)).c_str(),
                       std::string(app::resolutionName(resolution)).c_str(), times.parse, times.build, times.factor,
                       times.character);
    }
  }
  return out + "\n";
}

// Milliseconds against vertices, both logarithmic, one line a style and contender.
void drawGrowth(const std::string& folder, const std::vector<StageRow>& rows) {
  const std::string base = folder + "/growth", data = base + ".dat";
  std::ostringstream file;
  std::string plot;
  int index = 0;
  for (const Contender& contender : kContenders) {
    for (const char* style : {"shoulder", "long"}) {
      for (const StageRow& row : rows) {
        if (row.contender == std::string(contender.name) && row.style == style && row.motion == kMotions[0].name) {
          file << row.vertices << " " << row.total << "\n";
        }
      }
      file << "\n\n";
      plot += formatted("'%s' index %d using 1:2 with linespoints lw 2 lc %d dt %d pt %d title '%s, %s', \\\n",
                        data.c_str(), index, 1 + index / 2, 1 + index % 2, 5 + 2 * (index % 2), contender.name, style);
      ++index;
    }
  }
  app::writeFile(data, file.str());
  for (const char* kind : {"svg", "png"}) {
    std::ostringstream gp;
    gp << "set terminal "
       << (kind == std::string("svg") ? "svg size 860,560 background rgb 'white'" : "pngcairo size 860,560")
       << " font 'Sans,11'\nset output '" << base << "." << kind << "'\n"
       << "set logscale xy\nset grid\nset key outside right\nset xrange [300:12000]\n"
       << "set title 'A walk with contacts, 1/60 s a frame'\nset xlabel 'vertices'\n"
       << "set ylabel 'ms a frame, one thread'\nplot " << plot
       << "0.3 * (x / 361) ** 1.15 with lines lc rgb 'gray' dt 3 title '0.3 ms at 361, power 1.15'\n";
    runGnuplot(base + ".gp", gp.str(), {base + "." + kind});
  }
  std::filesystem::remove(data);
}

}  // namespace

void writePerformanceDocument(const std::string& folder) {
  const std::string name = folder + "/performance.md";
  const std::vector<StageRow> rows = measureStages();
  drawGrowth(dataFolder(folder), rows);
  const Table stages = stageTable(rows);
  writeTable(folder, "stages", stages);
  writeMeasuredPart(name, "walk", walkTable(stages).markdown());
  writeMeasuredPart(name, "start-up", startUpTable());
}

}  // namespace bench
