#include "tests/stress/heat_map.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "tests/bench/gnuplot.h"

namespace stress {
namespace {

constexpr double kSlowest = 6;      // s, the palette's end
constexpr double kFailedColor = 8;  // beyond it
constexpr double kUnknown = -1;     // no case there

// Which pieces of a case's name, between slashes, are a panel's rows and columns.
struct Panel {
  const char* family;
  const char* title;
  std::size_t row, column;
};
constexpr std::array<Panel, 4> kPanels{{{"speed", "Playback speed, by clip", 2, 1},
                                        {"step", "Time step, by clip", 2, 1},
                                        {"state", "Start state, by time step", 1, 2},
                                        {"upset", "Disturbance, by time step", 1, 2}}};

std::vector<std::string> pieces(const std::string& name) {
  std::vector<std::string> out;
  std::stringstream stream(name);
  for (std::string piece; std::getline(stream, piece, '/');) out.push_back(piece);
  return out;
}

struct Grid {
  std::vector<std::string> rows, columns;
  std::vector<std::vector<double>> slowest;  // s by row and column; kFailedColor where a case failed
  std::vector<std::vector<int>> failed;

  std::size_t indexOf(std::vector<std::string>& names, const std::string& name) {
    const auto known = std::find(names.begin(), names.end(), name);
    if (known != names.end()) return static_cast<std::size_t>(known - names.begin());
    names.push_back(name);
    return names.size() - 1;
  }
  void add(const std::string& row, const std::string& column, const Outcome& outcome) {
    const std::size_t r = indexOf(rows, row), c = indexOf(columns, column);
    slowest.resize(std::max(slowest.size(), r + 1));
    failed.resize(slowest.size());
    for (auto& line : slowest) line.resize(columns.size(), kUnknown);
    for (auto& line : failed) line.resize(columns.size(), 0);
    const bool fell = outcome.verdict == Verdict::kFailed;
    failed[r][c] += fell;
    const double color = fell ? kFailedColor : std::min(outcome.back_after, kSlowest);
    slowest[r][c] = std::max(slowest[r][c], color);
  }
};

Grid gather(const Panel& panel, const std::vector<Result>& results) {
  Grid grid;
  for (const Result& result : results) {
    if (result.one.family() != panel.family || result.outcome.verdict == Verdict::kSkipped) continue;
    const std::vector<std::string> name = pieces(result.one.name);
    grid.add(name[panel.row], name[panel.column], result.outcome);
  }
  return grid;
}

// Names hold underscores, which gnuplot would lower.
std::string label(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  const std::size_t step = name.find("1-");
  if (step == 0) name.replace(0, 2, "1/");
  return name;
}

void writePanel(const Panel& panel, const Grid& grid, std::ostream& plot) {
  plot << "set title '" << panel.title << "'\nunset label\nset xtics (";
  for (std::size_t c = 0; c < grid.columns.size(); ++c)
    plot << (c ? ", " : "") << "'" << label(grid.columns[c]) << "' " << c;
  plot << ")\nset ytics (";
  for (std::size_t r = 0; r < grid.rows.size(); ++r) plot << (r ? ", " : "") << "'" << label(grid.rows[r]) << "' " << r;
  plot << ")\nset xrange [-0.5:" << static_cast<double>(grid.columns.size()) - 0.5 << "]\nset yrange ["
       << static_cast<double>(grid.rows.size()) - 0.5 << ":-0.5]\n";
  plot << "$cells << EOD\n";
  std::ostringstream marks;
  for (std::size_t r = 0; r < grid.rows.size(); ++r) {
    for (std::size_t c = 0; c < grid.columns.size(); ++c) {
      if (grid.slowest[r][c] >= 0) plot << c << " " << r << " " << grid.slowest[r][c] << "\n";
      if (grid.failed[r][c] == 0) continue;
      marks << "set label '" << grid.failed[r][c] << "' at " << c << "," << r
            << " center front textcolor rgb 'white'\n";
    }
  }
  // Boxes, for an image needs two rows and columns.
  plot << "EOD\n"
       << marks.str()
       << "plot $cells using 1:2:(0.5):(0.5):3 with boxxyerror fillstyle solid noborder linecolor palette\n";
}

}  // namespace

void drawHeatMaps(const std::vector<Result>& results, const std::string& folder) {
  const std::string base = folder + "/stability_map";
  std::ostringstream plot;
  for (const bool svg : {true, false}) {
    plot << "set terminal " << (svg ? "svg" : "pngcairo") << " size 1240,1180 font 'Sans,11' background rgb 'white'\n"
         << "set output '" << base << "." << (svg ? "svg" : "png") << "'\n"
         << "set multiplot layout 2,2 title 'Slowest return to rest of each cell in seconds; black: cases that failed, "
            "counted'\n"
         << "set palette defined (0 '#1a9850', 2 '#d9ef8b', 4 '#fee08b', " << kSlowest << " '#d73027', "
         << kSlowest + 0.01 << " '#222222', " << kFailedColor << " '#222222')\nset cbrange [0:" << kFailedColor
         << "]\nset cbtics 0,1," << kSlowest
         << "\nset tics scale 0\nset xtics rotate by 35 right\nunset key\nset lmargin 25\n";
    for (const Panel& panel : kPanels) {
      const Grid grid = gather(panel, results);
      if (!grid.rows.empty()) writePanel(panel, grid, plot);
    }
    plot << "unset multiplot\n";
  }
  bench::runGnuplot(base + ".gp", plot.str(), {base + ".svg", base + ".png"});
}

}  // namespace stress
