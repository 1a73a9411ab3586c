// hairmesh-bench: measurements and pictures that the documents quote.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <vector>

#include "app/files/errors.h"
#include "app/files/output_file.h"
#include "app/options.h"
#include "app/run_main.h"
#include "tests/bench/accuracy_document.h"
#include "tests/bench/asked.h"
#include "tests/bench/brush_cost.h"
#include "tests/bench/colliders.h"
#include "tests/bench/collision_document.h"
#include "tests/bench/collisions.h"
#include "tests/bench/consistency.h"
#include "tests/bench/contact_sheet.h"
#include "tests/bench/conversion.h"
#include "tests/bench/draw_pareto.h"
#include "tests/bench/draw_passes.h"
#include "tests/bench/frames_budget.h"
#include "tests/bench/gate.h"
#include "tests/bench/ladder.h"
#include "tests/bench/pareto.h"
#include "tests/bench/peers.h"
#include "tests/bench/performance.h"
#include "tests/bench/shimmer.h"
#include "tests/bench/skin.h"
#include "tests/bench/skipping.h"
#include "tests/bench/solver_chart.h"
#include "tests/bench/styles_bench.h"
#include "tests/bench/swing.h"
#include "tests/bench/table.h"

namespace {

using bench::Asked;
using bench::Task;

std::vector<Task> tasks() {
  return {
      {"--styles", "milliseconds a frame per stage for the nine styles, walking, beside the paper's",
       [](Asked& a) { bench::runStyles(a.styles); }},
      {"--peers", "Bullet's soft bodies on the same hair mesh and motion, beside ours",
       [](Asked& a) { bench::runPeers(a.peers); }},
      {"--solvers", "residual against microseconds of every solver on recorded systems",
       [](Asked& a) { bench::runSolverChart(a.solvers); }},
      {"--pareto", "run time against error, for every scene and way to simulate it",
       [](Asked& a) { bench::runPareto(a.pareto); }},
      {"--draw-pareto", "drawing time against the picture's error, for every scene and setting; drawing.md in --out",
       [](Asked& a) {
         bench::runDrawPareto({a.pareto.scenes, a.pareto.folder, a.pareto.runs, a.pareto.quick});
       }},
      {"--draw-passes",
       "times of a frame's passes, strands beside triangles of the same strands; gpu.md in --out; exits 1 off bounds",
       [](Asked& a) {
         if (!bench::runDrawPasses({a.pareto.folder, a.pareto.runs, a.pareto.quick})) a.all_hold = false;
       }},
      {"--shimmer",
       "how much a slow camera's and a shaken head's picture shimmers beside its reference; exits 1 off bounds",
       [](Asked& a) {
         if (!bench::runShimmer()) a.all_hold = false;
       }},
      {"--consistency", "whether resolutions and time steps follow the same motion; tables of consistency.md in --out",
       [](Asked& a) { bench::runConsistency({a.pareto.folder}); }},
      {"--ladder", "cost and error of the budget governor's settings; a performance.md in --out gets their table",
       [](Asked& a) { bench::measureLadder(a.pareto.runs, a.pareto.folder); }},
      {"--collisions", "what is left inside the body, contacts that come and go, rest",
       [](Asked& a) {
         bench::writeClips(a.collisions, stdout);
         std::printf("\n");
         bench::writeRests(a.collisions, stdout);
       }},
      {"--skipping", "what every skip saves and changes on five scenes; exits 1 off its bounds",
       [](Asked& a) {
         if (!bench::runSkipping({a.pareto.folder, a.pareto.scenes, a.pareto.quick})) a.all_hold = false;
       }},
      {"--crowd", "the crowd's simulation beside the close-up's in --runs turns, and its shapes; exits 1 off bounds",
       [](Asked& a) {
         if (!bench::runCrowd(a.pareto.runs)) a.all_hold = false;
       }},
      {"--colliders", "ellipsoids and signed distances side by side, against the true skin",
       [](Asked& a) {
         bench::runColliders({a.styles.frames, a.collisions.clips, a.collisions.styles}, stdout);
       }},
      {"--collision-document", "all that collisions claim, into the tables of collision.md in the folder of --out",
       [](Asked& a) { bench::writeCollisionDocument(a.pareto.folder, a.styles.frames); }},
      {"--frames-budget",
       "what steps of whole clips cost over a walk's median, preset natural, in counted work; exits 1 off its bounds",
       [](Asked& a) {
         if (!bench::runFramesBudget(a.frames_budget)) a.all_hold = false;
       }},
      {"--skin",
       "how far drawn strands reach into the drawn skin, over whole clips of every figure; exits 1 off bounds",
       [](Asked& a) {
         if (!bench::runSkin(a.skin)) a.all_hold = false;
       }},
      {"--swing",
       "how fast free hair swings, how soon it stops and how far it goes on after a turn of the head, for the presets "
       "of hair; exits 1 where natural hair leaves its bounds",
       [](Asked& a) {
         if (!bench::runSwing(a.swing)) a.all_hold = false;
       }},
      {"--brushes", "what a brush's edit of 2,257 moving vertices costs, per tool; exits 1 where its p99 exceeds 8 ms",
       [](Asked& a) {
         if (!bench::runBrushCost()) a.all_hold = false;
       }},
      {"--conversion", "grooms of ten kinds to hair meshes: distances, silhouettes, time",
       [](Asked& a) { bench::runConversion(a.conversion); }},
      {"--gate", "every bound on speed and accuracy, one line each; exits 1 where one falls short",
       [](Asked& a) {
         const std::vector<bench::Figure> figures = bench::measureFigures(a.gate);
         if (!bench::allHold(figures)) a.all_hold = false;
         if (!a.gate_document.empty()) bench::writeGateDocument(figures, !a.gate.part.empty(), a.gate_document);
       }},
  };
}

void addOptions(CLI::App& program, Asked& a) {
  program.add_option("--frames", a.styles.frames, "measured frames a style")->check(CLI::Range(10, 100000));
  program.add_option("--motion", a.styles.motion, "clip to walk with")->capture_default_str();
  program.add_option("--table", a.styles.table, "also write the table of --styles to this Markdown file");
  program.add_option("--contact-sheet", a.sheet.folder,
                     "draw the nine styles, at rest and in motion, into this folder");
  program.add_option("--cell", a.sheet.cell_height, "height of a picture of the sheet, pixels")
      ->check(CLI::Range(32, 2048));
  program.add_option("--strands", a.sheet.strands, "strands a picture")->check(CLI::Range(1, 1000000));
  program.add_option("--scenes", a.pareto.scenes, "scenes of --pareto, --draw-pareto and --skipping, comma separated")
      ->delimiter(',');
  program
      .add_option("--out", a.pareto.folder,
                  "folder of what is written; docs/data/columns.md explains the columns of its pareto.csv")
      ->default_val("pareto");
  program.add_option("--references", a.pareto.references,
                     "folder in which --pareto and --gate keep their reference trajectories");
  program.add_option("--runs", a.pareto.runs, "timed runs a point")->check(CLI::Range(1, 100));
  program.add_flag("--quick", a.pareto.quick, "a coarser sweep");
  program
      .add_option(
          "--only", a.collisions.styles,
          "styles of --collisions, --colliders, --frames-budget and --skin, such as 'long low', comma separated")
      ->delimiter(',');
  program
      .add_option("--clips", a.collisions.clips,
                  "clips of --collisions, --colliders, --frames-budget and --skin, comma separated")
      ->delimiter(',');
  program.add_option("--speeds", a.frames_budget.speeds, "playback speeds of --frames-budget, comma separated")
      ->delimiter(',')
      ->check(CLI::Range(0.01, 100.0));
  program.add_option("--steps", a.frames_budget.steps, "CSV file of every step of --frames-budget");
  program.add_option("--frames-budget-document", a.frames_budget.folder,
                     "also put --frames-budget's table and chart into this folder's performance.md");
  program.add_option("--skin-strands", a.skin.strands, "strands that --skin looks at")->check(CLI::Range(1, 100000));
  program.add_option("--skin-speed", a.skin.speed, "playback speed of --skin")->check(CLI::Range(0.01, 100.0));
  program.add_option("--skin-document", a.skin.folder,
                     "also put --skin's table into this folder's skin.md, and every clip into data/skin.csv");
  program.add_option("--set", a.sets, "NAME=VALUE of a parameter for --collisions, --skin and --swing")
      ->allow_extra_args(false);
  program.add_option("--conversion-document", a.conversion.folder,
                     "also put --conversion's tables into this folder's conversion.md");
  program.add_option("--rounds", a.gate.rounds, "turns that the compared ways of --gate take")
      ->check(CLI::Range(1, 100));
  program.add_option("--gate-part", a.gate.part, "measure these lines of --gate alone; others stay in its document")
      ->check(CLI::IsMember({"speed", "consistency", "sweep", "drawing"}));
  program.add_option("--gate-document", a.gate_document, "also put --gate's figures into this folder's gate.md");
  program.add_option("--performance-document", a.performance,
                     "measure stages, growth and start-up into this folder's performance.md");
  program.add_option("--accuracy-document", a.document,
                     "put the tables of what this folder's data holds into its accuracy.md");
  program.add_option("--accuracy", a.accuracy,
                     "all of accuracy.md in this folder: a quick sweep, solvers, peers, tables");
}

// What options mean for one another.
void settle(const CLI::App& program, std::vector<Task>& all, Asked& a) {
  if (!a.accuracy.empty()) {
    for (Task& task : all) {
      for (const char* part : {"--pareto", "--solvers", "--peers"})
        task.asked = task.asked || task.flag == std::string(part);
    }
    a.pareto.quick = true;
    a.document = a.accuracy;
    a.pareto.folder = a.accuracy + "/data";
  }
  a.gate.references = a.pareto.references;
  a.solvers.folder = a.peers.folder = a.pareto.folder;
  a.collisions.frames = a.styles.frames;
  a.frames_budget.styles = a.skin.styles = a.collisions.styles;
  if (program.count("--clips") > 0) a.frames_budget.clips = a.skin.clips = a.collisions.clips;
  for (const std::string& text : a.sets) {
    const std::size_t equals = text.find('=');
    a.collisions.set.emplace_back(text.substr(0, equals), equals < text.size() ? text.substr(equals + 1) : "");
  }
  a.skin.sets = a.swing.sets = a.collisions.set;
}

// Everything that was asked for, in order.
void measure(const std::vector<Task>& all, Asked& asked) {
  bench::checkAsked(all, asked);
  bench::checkOutputs(all, asked);
  for (const Task& task : all) {
    if (task.asked) task.run(asked);
  }
  if (!asked.document.empty()) bench::writeAccuracyDocument(asked.document);
  if (!asked.performance.empty()) bench::writePerformanceDocument(asked.performance);
  if (!asked.sheet.folder.empty()) bench::drawContactSheets(asked.sheet);
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a run that is cut short leaves what it has said
  app::failAtFileLimit();
  CLI::App program("Measures the simulator and draws the documents' pictures. One thread; timings are medians.");
  std::vector<Task> all = tasks();
  Asked asked;
  for (Task& task : all) program.add_flag(task.flag, task.asked, task.help);
  addOptions(program, asked);
  return app::runMain("hairmesh-bench", [&]() -> int {
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& fault) {
      return program.exit(fault) == 0 ? app::kExitFine : app::kExitUsage;
    }
    settle(program, all, asked);
    const bool any = std::any_of(all.begin(), all.end(), [](const Task& task) { return task.asked; });
    if (!any && asked.document.empty() && asked.performance.empty() && asked.sheet.folder.empty()) {
      std::cout << program.help();
      return app::kExitUsage;
    }
    measure(all, asked);
    return bench::exitCodeOf(asked.all_hold);
  });
}
