#include "tests/bench/skipping_document.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "app/files/output_file.h"
#include "tests/bench/gnuplot.h"
#include "tests/bench/measured_part.h"
#include "tests/bench/table.h"

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
    const app::SkipCount& count = row.skipped[skip.id];
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
  const std::string data = base + ".dat";
  std::ostringstream stream, gp;
  for (const SkipRow& row : rows)
    stream << '"' << row.skips << "\" " << row.simulation_ms << ' ' << row.character_ms << ' ' << row.drawing_ms
           << '\n';
  app::writeFile(data, stream.str());
  gp << "set terminal svg size 860,420 background rgb 'white'\nset output '" << base << ".svg'\n"
     << "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.9 noborder\n"
     << "set boxwidth 0.75\nset xtics rotate by -35 noenhanced\nset ylabel 'ms a frame (process time)'\nset grid "
        "ytics\n"
     << "set key outside top horizontal\n"
     << "plot '" << data
     << "' using 2:xtic(1) title 'simulation' lc rgb '#e28c58', '' using 3 title 'character' lc rgb "
     << "'#b084c4', '' using 4 title 'drawing' lc rgb '#56789e'\n";
  runGnuplot(base + ".gp", gp.str(), {base + ".svg"});
  std::filesystem::remove(data);
}

std::vector<SkipBound> skipBounds(const SkipScenes& scenes) {
  std::vector<SkipBound> all;
  const SkipRow *without = find(scenes, "still_close_up", "none"), *still = find(scenes, "still_close_up", "all");
  const SkipRow *close = find(scenes, "walk", "all"), *crowd = find(scenes, "crowd", "all");
  if (without && still) all.push_back({"still close-up, all skips over none", still->frame() / without->frame(), 0.02});
  if (close && crowd) {
    all.push_back({"simulation of the crowd over one close-up's (walk)", crowd->simulation_ms / close->simulation_ms,
                   kCrowdRatio});
    all.push_back(
        {"drawing of the crowd over one close-up's (walk)", crowd->drawing_like_close_up_ms / close->drawing_ms, 4});
    const long more =
        crowd->gpu_bytes_hair + crowd->gpu_bytes_shadows - close->gpu_bytes_hair - close->gpu_bytes_shadows;
    all.push_back({"KB on the GPU for each of the crowd beyond the close-up's one", more / 1024.0 / 99, 100});
  }
  for (const std::vector<SkipRow>& rows : scenes) {
    const SkipRow &first = rows.front(), &last = rows.back();
    double pixels = 0;
    for (const SkipRow& row : rows) pixels = std::max(pixels, row.simulation_error_pixels);
    all.push_back({"pixels that the shapes of " + first.scene + " are off by at most", pixels, kShapePixels});
    all.push_back({"frame of " + first.scene + ", all skips over none", last.frame() / first.frame(), 1.03});
  }
  return all;
}

std::string boundText(const SkipBound& bound) {
  return bound.what + ": " + number(bound.value) + " of at most " + number(bound.most);
}

namespace {

std::string boundTable(const std::vector<SkipBound>& held) {
  std::string text = "| bound | measured | at most | |\n|---|---|---|---|\n";
  for (const SkipBound& bound : held)
    text += "| " + bound.what + " | " + number(bound.value) + " | " + number(bound.most) + " | " +
            (bound.holds() ? "holds" : "**fails**") + " |\n";
  return text + "\n";
}

// Rows of every scene, under its name: every skip alone, all and none; or, of `ends`, none and all.
Table sceneTable(const SkipScenes& scenes, bool ends) {
  Table table;
  for (const std::vector<SkipRow>& rows : scenes) {
    const std::string text = ends ? skipTableOf({rows.front(), rows.back()}) : skipTableOf(rows);
    append(withColumn("scene", rows.front().scene, tableOf(text)), table);
  }
  return table;
}

// The parts' marks alone, for a folder that has no page yet.
constexpr const char* kEmptyDocument =
    "# What is skipped, and what it changes\n\n"
    "## Result\n\n<!-- measured: scenes -->\n<!-- end of scenes -->\n\n"
    "## Bounds\n\n<!-- measured: bounds -->\n<!-- end of bounds -->\n";
constexpr const char* kEmptyTable = "# The table of skips\n\n<!-- measured: skips -->\n<!-- end of skips -->\n";

}  // namespace

void startSkipDocument(const std::string& folder) {
  const std::string page = folder + "/skipping.md", table = dataFolder(folder) + "/skips.md";
  if (!std::filesystem::exists(page)) app::writeFile(page, kEmptyDocument);
  if (!std::filesystem::exists(table)) app::writeFile(table, kEmptyTable);
  writeMeasuredPart(table, "skips", app::skipTableText() + "\n");
}

void writeSkipDocument(const SkipScenes& scenes, const std::vector<SkipBound>& held, const std::string& folder) {
  const std::string file = folder + "/skipping.md";
  writeTable(folder, "skipping", sceneTable(scenes, false));
  writeMeasuredPart(file, "bounds", boundTable(held));
  writeMeasuredPart(file, "scenes",
                    columns(sceneTable(scenes, true), {"scene", "skips", "simulation ms", "drawing ms", "frame ms",
                                                       "shape off by mm (pixels)", "picture off by levels"})
                        .markdown());
}

}  // namespace bench
