#include "tests/bench/gnuplot.h"

#include <sstream>

#include "tests/bench/written_files.h"

namespace bench {

void drawChart(const std::string& folder, const std::string& name, const Chart& chart) {
  const std::string base = folder + "/" + name;
  std::ostringstream gp;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    gp << "$series" << k << " << END\n";
    for (const auto& [x, y] : chart.series[k].points) gp << x << " " << y << "\n";
    gp << "END\n";
  }
  gp << "set logscale xy\nset format y '10^{%L}'\nset grid\nset key outside right font ',10'\n"
     << "set title '" << chart.title << "' noenhanced\nset xlabel '" << chart.x_label << "'\nset ylabel '"
     << chart.y_label << "'\n";
  for (const char* kind : {"svg", "png"}) {
    gp << "set terminal "
       << (std::string(kind) == "svg" ? "svg size 900,560 background rgb 'white'" : "pngcairo size 900,560")
       << " font 'Sans,11'\nset output '" << base << "." << kind << "'\nplot ";
    bool first = true;
    for (std::size_t k = 0; k < chart.series.size(); ++k) {
      if (chart.series[k].points.empty()) continue;
      gp << (first ? "" : ", \\\n  ") << "$series" << k << " using 1:2 with " << chart.series[k].style << " title '"
         << chart.series[k].title << "' noenhanced";
      first = false;
    }
    gp << "\nset output\n";
  }
  runGnuplot(base + ".gp", gp.str(), {base + ".svg", base + ".png"});
}

}  // namespace bench
