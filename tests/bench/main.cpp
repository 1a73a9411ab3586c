// hairmesh-bench: measurements and pictures that the documents quote.
#include <CLI/CLI.hpp>
#include <iostream>

#include "app/errors.h"
#include "tests/bench/accuracy_document.h"
#include "tests/bench/colliders.h"
#include "tests/bench/collisions.h"
#include "tests/bench/contact_sheet.h"
#include "tests/bench/ladder.h"
#include "tests/bench/pareto.h"
#include "tests/bench/peers.h"
#include "tests/bench/solver_chart.h"
#include "tests/bench/styles_bench.h"

int main(int argc, char** argv) {
  CLI::App program("Measures the simulator and draws the documents' pictures. One thread; timings are medians.");
  bench::StylesOptions styles;
  bench::SheetOptions sheet;
  bench::ParetoOptions pareto;
  bench::SolverChartOptions solvers;
  bench::PeersOptions peers;
  bench::CollisionOptions collisions;
  std::vector<std::string> sets;
  bool run_styles = false, run_pareto = false, run_solvers = false, run_peers = false, run_collisions = false,
       run_colliders = false;
  program.add_flag("--styles", run_styles,
                   "milliseconds a frame per stage for the nine styles, walking, beside the paper's");
  program.add_option("--frames", styles.frames, "measured frames a style")->check(CLI::Range(10, 100000));
  program.add_option("--motion", styles.motion, "clip to walk with")->capture_default_str();
  program.add_option("--table", styles.table, "also write the table to this Markdown file");
  program.add_option("--contact-sheet", sheet.folder, "draw the nine styles, at rest and in motion, into this folder");
  program.add_option("--cell", sheet.cell_height, "height of a picture of the sheet, pixels")
      ->check(CLI::Range(32, 2048));
  program.add_option("--strands", sheet.strands, "strands a picture")->check(CLI::Range(1, 1000000));
  program.add_flag("--pareto", run_pareto, "run time against error, for every scene and way to simulate it");
  program.add_option("--scenes", pareto.scenes, "scenes of --pareto, comma separated")->delimiter(',');
  program.add_flag("--solvers", run_solvers, "residual against microseconds of every solver on recorded systems");
  program.add_flag("--peers", run_peers, "Bullet's soft bodies on the same hair mesh and motion, beside ours");
  program.add_option("--out", pareto.folder, "folder of --pareto, --solvers and --peers")->default_val("pareto");
  program.add_option("--references", pareto.references, "folder in which --pareto keeps its reference trajectories");
  program.add_option("--runs", pareto.runs, "timed runs a point")->check(CLI::Range(1, 100));
  program.add_flag("--quick", pareto.quick, "a coarser sweep");
  bool run_ladder = false;
  program.add_flag("--ladder", run_ladder,
                   "cost and error of the budget governor's settings (app/governor_ladder.cpp)");
  program.add_flag("--collisions", run_collisions, "what is left inside the body, contacts that come and go, rest");
  program.add_flag("--colliders", run_colliders, "ellipsoids and signed distances side by side, against the true skin");
  program
      .add_option("--only", collisions.styles,
                  "styles of --collisions and --colliders, such as 'long low', comma separated")
      ->delimiter(',');
  program.add_option("--clips", collisions.clips, "clips of --collisions and --colliders, comma separated")
      ->delimiter(',');
  program.add_option("--set", sets, "NAME=VALUE of a parameter for --collisions")->allow_extra_args(false);
  std::string document;
  program.add_option("--accuracy-document", document, "put the tables of this folder's sweep into its accuracy.md");
  CLI11_PARSE(program, argc, argv);
  if (!run_styles && !run_pareto && !run_solvers && !run_peers && !run_ladder && !run_collisions && !run_colliders &&
      document.empty() && sheet.folder.empty()) {
    std::cout << program.help();
    return app::kExitUsage;
  }
  try {
    if (run_styles) bench::runStyles(styles);
    solvers.folder = pareto.folder;
    peers.folder = pareto.folder;
    if (run_peers) bench::runPeers(peers);
    if (run_solvers) bench::runSolverChart(solvers);
    if (run_pareto) bench::runPareto(pareto);
    if (run_ladder) bench::measureLadder(pareto.runs);
    if (run_collisions) {
      collisions.frames = styles.frames;
      for (const std::string& text : sets) {
        const std::size_t equals = text.find('=');
        collisions.set.emplace_back(text.substr(0, equals), equals < text.size() ? text.substr(equals + 1) : "");
      }
      bench::runCollisions(collisions);
    }
    if (run_colliders) bench::runColliders({styles.frames, collisions.clips, collisions.styles});
    if (!document.empty()) bench::writeAccuracyDocument(document);
    if (!sheet.folder.empty()) bench::drawContactSheets(sheet);
  } catch (const app::ContextError& error) {
    std::cerr << "hairmesh-bench: " << error.what() << "\n";
    return app::kExitNoContext;
  } catch (const app::InputError& error) {
    std::cerr << "hairmesh-bench: " << error.what() << "\n";
    return app::kExitBadInput;
  }
  return app::kExitFine;
}
