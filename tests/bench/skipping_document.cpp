#include "tests/bench/skipping_document.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace bench {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text,
                value == 0               ? "0"
                : std::abs(value) < 0.01 ? "%.4f"
                : value < 10             ? "%.2f"
                                         : "%.1f",
                value);
  return text;
}

// How much the skips of a row left out, the row's own first.
std::string counters(const SkipRow& row) {
  std::string text;
  for (const app::Skip& skip : app::skipTable()) {
    const app::SkipTally& count = row.skipped[skip.id];
    if (count.skipped == 0 || count.of == 0 || (row.skips != "all" && row.skips != skip.name)) continue;
    char part[96];
    std::snprintf(part, sizeof part, "%s%.0f %% of %s", text.empty() ? "" : ", ",
                  100.0 * static_cast<double>(count.skipped) / static_cast<double>(count.of), skip.counts);
    text += part;
    if (row.skips == "all") text += std::string(" (") + skip.name + ")";
  }
  return text.empty() ? "-" : text;
}

const SkipRow* find(const SkipScenes& scenes, const std::string& scene, const std::string& skips) {
  for (const std::vector<SkipRow>& rows : scenes) {
    for (const SkipRow& row : rows) {
      if (row.scene == scene && row.skips == skips) return &row;
    }
  }
  return nullptr;
}

}  // namespace

std::string skipTableOf(const std::vector<SkipRow>& rows) {
  std::string text =
      "| skips | simulation ms | character ms | drawing ms | frame ms | shape off by mm (pixels) | picture off by "
      "levels "
      "| left out |\n|---|---|---|---|---|---|---|---|\n";
  for (const SkipRow& row : rows) {
    text += "| " + row.skips + " | " + number(row.simulation_ms) + " | " + number(row.character_ms) + " | " +
            number(row.drawing_ms) + " | " + number(row.frame()) + " | " + number(row.simulation_error_mm) + " (" +
            number(row.simulation_error_pixels) + ") | " + number(row.image_error) + " | " + counters(row) + " |\n";
  }
  return text;
}

void plotSkips(const std::vector<SkipRow>& rows, const std::string& folder) {
  const std::string base = folder + "/skipping_" + rows.front().scene;
  const std::string data = base + ".dat", script = base + ".gp";
  {
    std::ofstream stream(data);
    for (const SkipRow& row : rows)
      stream << '"' << row.skips << "\" " << row.simulation_ms << ' ' << row.character_ms << ' ' << row.drawing_ms
             << '\n';
    std::ofstream gp(script);
    gp << "set terminal svg size 860,420 background rgb 'white'\nset output '" << base << ".svg'\n"
       << "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.9 noborder\n"
       << "set boxwidth 0.75\nset xtics rotate by -35 noenhanced\nset ylabel 'ms a frame (process time)'\nset grid "
          "ytics\n"
       << "set key outside top horizontal\n"
       << "plot '" << data
       << "' using 2:xtic(1) title 'simulation' lc rgb '#e28c58', '' using 3 title 'character' lc rgb "
       << "'#b084c4', '' using 4 title 'drawing' lc rgb '#56789e'\n";
  }
  if (std::system(("gnuplot '" + script + "'").c_str()) != 0)
    std::printf("no plot: gnuplot is not installed or failed\n");
  std::filesystem::remove(data);
  std::filesystem::remove(script);
}

std::vector<SkipBound> skipBounds(const SkipScenes& scenes) {
  std::vector<SkipBound> all;
  const SkipRow *without = find(scenes, "still_close_up", "none"), *still = find(scenes, "still_close_up", "all");
  const SkipRow *close = find(scenes, "walk", "all"), *crowd = find(scenes, "hundred", "all");
  if (without && still) all.push_back({"still close-up, all skips over none", still->frame() / without->frame(), 0.02});
  if (close && crowd) {
    all.push_back(
        {"simulation of the hundred over one close-up's (walk)", crowd->simulation_ms / close->simulation_ms, 6});
    all.push_back(
        {"drawing of the hundred over one close-up's (walk)", crowd->drawing_like_close_up_ms / close->drawing_ms, 4});
    const long more =
        crowd->gpu_bytes_hair + crowd->gpu_bytes_shadows - close->gpu_bytes_hair - close->gpu_bytes_shadows;
    all.push_back({"KB on the GPU for each of the hundred beyond the close-up's one", more / 1024.0 / 99, 100});
  }
  for (const std::vector<SkipRow>& rows : scenes) {
    const SkipRow &first = rows.front(), &last = rows.back();
    double pixels = 0;
    for (const SkipRow& row : rows) pixels = std::max(pixels, row.simulation_error_pixels);
    all.push_back({"pixels that the shapes of " + first.scene + " are off by at most", pixels, 3});
    all.push_back({"frame of " + first.scene + ", all skips over none", last.frame() / first.frame(), 1.03});
  }
  return all;
}

std::string boundText(const SkipBound& bound) {
  return bound.what + ": " + number(bound.value) + " of at most " + number(bound.most);
}

// Measured once, when each was tried; what became of them needs no table.
constexpr const char* kNotKept =
    "\n## Tried, and not kept\n\n"
    "- Bundles wholly behind the head (an ellipsoid fitted inside the skull hides a convex region, so the test is "
    "exact "
    "and cheap): 4 to 8 % of the bundles of short hair, 0 to 4 % of longer hair. A quarter of all vertices lies behind "
    "the head, but their bundles reach out above or below it.\n"
    "- Linear solves that stop at a 40th of a pixel: 3 to 7 % of the iterations of a shaken head, near or far. "
    "Contacts "
    "make such motion part from any other run of it by centimetres within a second, so that no bound could be "
    "stated.\n"
    "- Bounds of single bundles against single colliders, last frame's contacts first: all of collision is 1 to 5 % of "
    "a step, and colliders out of reach of the whole hair are left out already.\n"
    "- Constant blocks of the system's matrix: the masses alone are constant.\n"
    "- One pose a frame where a frame takes several steps: each step needs the roots and colliders of its own moment; "
    "skinning and upload happen once a frame.\n"
    "- Shadow maps of far hair at a lower rate: a far map has a few hundred strands already, and one that is late "
    "swims.\n";

std::string skipDocument(const SkipScenes& scenes, const std::vector<SkipBound>& held) {
  std::string text =
      "# What is skipped, and what it changes\n\n"
      "Written by `hairmesh-bench --skipping --out docs`. A still scene costs nothing, a distant crowd little, a "
      "close-up "
      "gets all of it. Every skip has a switch (`--skip NAME=off`), a counter (window, `--report`) and a test.\n\n"
      "## The ledger\n\n" +
      app::skipLedger() + "\n## Bounds\n\n| bound | measured | at most | |\n|---|---|---|---|\n";
  for (const SkipBound& bound : held)
    text += "| " + bound.what + " | " + number(bound.value) + " | " + number(bound.most) + " | " +
            (bound.holds() ? "holds" : "**fails**") + " |\n";
  text +=
      "\n## Scenes\n\nMeans (drawing: medians) over the frames of process time (all threads of the software rasterizer "
      "count, so its "
      "milliseconds are CPU time, not waiting). Every skip alone, all, none. Shapes: mean over a head's vertices, the "
      "worst head and frame against none, and the same in pixels of a picture 720 high, for whose care the simulation "
      "is "
      "run. Pictures: mean over all pixels and channels, of 255, the worst frame. A skip that leaves nothing out in a "
      "scene has no row there. Simulation bounds are held against long hair walking near the camera with all skips, "
      "drawing bounds against its picture, the hundred then drawn with as many strands a head and as large shadow "
      "maps.\n";
  for (const std::vector<SkipRow>& rows : scenes) {
    const std::string& scene = rows.front().scene;
    text += "\n### " + scene + "\n\n![none](skipping_" + scene + "_none.png) ![all](skipping_" + scene +
            "_all.png)\n\nWithout skips and with all, " + rows.front().setup + ".\n\n![times](skipping_" + scene +
            ".svg)\n\n" + skipTableOf(rows);
  }
  return text + kNotKept;
}

}  // namespace bench
