#include "tests/bench/performance.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "app/errors.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/timed_scene.h"
#include "tests/bench/waits.h"

namespace bench {
namespace {

using sim::Resolution;
using sim::SimParams;
using sim::Style;

constexpr const char* kRegionStart = "<!-- measured by hairmesh-bench -->";
constexpr const char* kRegionEnd = "<!-- end of the measured part -->";
constexpr double kSeconds = 0.5;  // of each scene

std::string text(const char* format, auto... values) {
  char line[300];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

// Who simulates.
struct Contender {
  const char* name;
  sim::Solver solver;
  Way way;
  Resolution finest;  // it is run on: the plain implementation takes seconds a frame on finer ones
};
constexpr Contender kContenders[] = {
    {"default", sim::Solver::kWarped, Way::kSimulator, Resolution::kUltra},
    {"--solver paper", sim::Solver::kPaper, Way::kSimulator, Resolution::kUltra},
    {"plain implementation", sim::Solver::kDiagonal, Way::kPlain, Resolution::kHigh},
};

struct Motion {
  const char *name, *file;
  bool collide;
};
constexpr Motion kMotions[] = {{"walk, with contacts", "walk.bvh", true},
                               {"head shake, without", "head_shake.bvh", false}};

struct Row {
  const char* contender;
  const char* motion;
  std::string style, resolution;
  int vertices = 0, iterations = 0, contacts = 0;
  double total = 0, character = 0;                // ms, medians over frames
  std::array<double, sim::kStageCount> stages{};  // ms, means: a stage that seldom runs still counts
};

Row rowOf(const TimedRun& run) {
  Row row;
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

std::vector<Row> measureStages() {
  std::vector<Row> rows;
  for (const Motion& motion : kMotions) {
    for (const Style style : {Style::kShort, Style::kShoulder, Style::kLong}) {
      for (const Resolution resolution :
           {Resolution::kLow, Resolution::kMedium, Resolution::kHigh, Resolution::kUltra}) {
        TimedScene scene(motion.file, style, resolution, motion.collide);
        for (const Contender& contender : kContenders) {
          if (resolution > contender.finest) continue;
          SimParams params;
          params.solver = contender.solver;
          // The first run makes what the others keep: force model, factors, memory.
          const double seconds = contender.way == Way::kPlain ? kSeconds / 4 : kSeconds;
          scene.run(params, seconds, contender.way);
          Row row = rowOf(scene.run(params, seconds, contender.way));
          row.contender = contender.name, row.motion = motion.name;
          row.style = sim::styleName(style), row.resolution = sim::resolutionName(resolution);
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

std::string stageTables(const std::vector<Row>& rows) {
  std::string out;
  for (const Contender& contender : kContenders) {
    out += text("### Stages: %s\n\n", contender.name);
    out +=
        "| scene | style | vertices | ms a frame | forces | solve | collision | minimization | other | character | "
        "iterations | contacts |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Row& row : rows) {
      if (row.contender != std::string(contender.name)) continue;
      double sum = 0;
      for (const double ms : row.stages) sum += ms;
      out += text("| %s | %s %s | %d | %.3f |", row.motion, row.style.c_str(), row.resolution.c_str(), row.vertices,
                  row.total);
      for (const double ms : row.stages) out += text(" %.3f (%.0f %%) |", ms, 100 * ms / std::max(sum, 1e-12));
      out += text(" %.3f | %d | %d |\n", row.character, row.iterations, row.contacts);
    }
    out += "\n";
  }
  return out;
}

// The first measurement of this page (2026-11-21, commit 8f47a82), ms: the default's stages in a walk, and a frame of
// the plain implementation in the same run. How busy the machine is differs from run to run, so that only shares of
// that frame compare; the plain implementation is still the same.
struct FirstMeasured {
  const char *style, *resolution;
  int vertices, iterations;
  double plain, total;
  std::array<double, sim::kStageCount> stages;
};
constexpr FirstMeasured kFirst[] = {
    {"long", "low", 365, 6, 2.305, 0.561, {0.088, 0.342, 0.082, 0.081, 0.015}},
    {"long", "medium", 922, 6, 9.338, 2.144, {0.243, 1.416, 0.149, 0.206, 0.041}},
    {"long", "high", 2268, 90, 29.486, 11.959, {0.584, 10.625, 0.273, 0.579, 0.088}},
    {"shoulder", "low", 360, 2, 2.297, 0.284, {0.066, 0.168, 0.027, 0.009, 0.012}},
    {"shoulder", "high", 2306, 4, 23.750, 5.392, {0.560, 4.766, 0.121, 0.000, 0.091}},
};

const Row* rowIn(const std::vector<Row>& rows, const Contender& contender, const FirstMeasured& first) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.contender == std::string(contender.name) && row.motion == kMotions[0].name && row.style == first.style &&
           row.resolution == first.resolution;
  });
  return found == rows.end() ? nullptr : &*found;
}

// What became of each stage: hundredths of the plain implementation's frame, at first and now.
std::string thenAndNowTable(const std::vector<Row>& rows) {
  std::string out =
      "### A walk's stages, at first and now\n\nIn hundredths of the plain implementation's frame in the same run.\n\n"
      "| style | vertices | a frame | forces | solve | collision | minimization | other | iterations |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const FirstMeasured& first : kFirst) {
    const Row *ours = rowIn(rows, kContenders[0], first), *plain = rowIn(rows, kContenders[2], first);
    if (!ours || !plain) continue;
    const double then = 100 / first.plain, now = 100 / plain->total;
    out += text("| %s %s | %d, %d | %.1f, now %.1f |", first.style, first.resolution, first.vertices, ours->vertices,
                then * first.total, now * ours->total);
    for (int s = 0; s < sim::kStageCount; ++s) {
      out += text(" %.2f, now %.2f |", then * first.stages[s], now * ours->stages[s]);
    }
    out += text(" %d, now %d |\n", first.iterations, ours->iterations);
  }
  return out + "\n";
}

std::string startUpTable() {
  std::string out =
      "### Start-up\n\n| style | parse, s | build, s | first step with factor, s | character, style and mesh grown, s "
      "|\n|---|---|---|---|---|\n";
  for (const Style style : {Style::kShoulder, Style::kLong}) {
    for (const Resolution resolution : {Resolution::kLow, Resolution::kHigh, Resolution::kUltra}) {
      const StartUp times = measureStartUp(style, resolution);
      out += text("| %s %s | %.3f | %.3f | %.3f | %.3f |\n", std::string(sim::styleName(style)).c_str(),
                  std::string(sim::resolutionName(resolution)).c_str(), times.parse, times.build, times.factor,
                  times.character);
    }
  }
  return out + "\n";
}

// Milliseconds against vertices, both logarithmic, one line a style and contender.
void drawGrowth(const std::string& folder, const std::vector<Row>& rows) {
  const std::string data = folder + "/growth.dat", script = folder + "/growth.gp";
  std::ofstream file(data);
  std::string plot;
  int index = 0;
  for (const Contender& contender : kContenders) {
    for (const char* style : {"shoulder", "long"}) {
      for (const Row& row : rows) {
        if (row.contender == std::string(contender.name) && row.style == style && row.motion == kMotions[0].name) {
          file << row.vertices << " " << row.total << "\n";
        }
      }
      file << "\n\n";
      plot += text("'%s' index %d using 1:2 with linespoints lw 2 lc %d dt %d pt %d title '%s, %s', \\\n", data.c_str(),
                   index, 1 + index / 2, 1 + index % 2, 5 + 2 * (index % 2), contender.name, style);
      ++index;
    }
  }
  file.close();
  for (const char* kind : {"svg", "png"}) {
    std::ofstream(script)
        << "set terminal "
        << (kind == std::string("svg") ? "svg size 860,560 background rgb 'white'" : "pngcairo size 860,560")
        << " font 'Sans,11'\nset output '" << folder << "/growth." << kind << "'\n"
        << "set logscale xy\nset grid\nset key outside right\nset xrange [300:12000]\n"
        << "set title 'A walk with contacts, 1/60 s a frame'\nset xlabel 'vertices'\n"
        << "set ylabel 'ms a frame, one thread'\nplot " << plot
        << "0.3 * (x / 361) ** 1.15 with lines lc rgb 'gray' dt 3 title '0.3 ms at 361, power 1.15'\n";
    if (std::system(("gnuplot '" + script + "'").c_str()) != 0) {
      std::printf("no growth.%s: gnuplot is not installed or failed\n", kind);
    }
  }
  std::filesystem::remove(script);
  std::filesystem::remove(data);
}

}  // namespace

void writePerformanceDocument(const std::string& folder, const GateOptions& gate) {
  const std::string name = folder + "/performance.md";
  std::ifstream stream(name);
  const std::string old((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  const auto start = old.find(kRegionStart), end = old.find(kRegionEnd);
  if (start == std::string::npos || end == std::string::npos || end < start) {
    throw app::InputError(name, "", "lacks the marks of the measured part", "restore it from the repository");
  }
  const std::vector<Figure> figures = measureSpeed(gate);
  const std::vector<Row> rows = measureStages();
  drawGrowth(folder, rows);
  std::ofstream(name) << old.substr(0, start) << kRegionStart << "\n\n"
                      << "### Figures\n\n"
                      << figureTable(figures) << "\n"
                      << stageTables(rows) << thenAndNowTable(rows) << "### Growth\n\n![growth](growth.svg)\n\n"
                      << startUpTable() << old.substr(end);
}

}  // namespace bench
