// Log-log charts by gnuplot, as SVG and PNG.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bench {

struct Series {
  std::string title;
  std::string style;  // gnuplot's words after `with`
  std::vector<std::pair<double, double>> points;
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};

// Writes <folder>/<name>.svg and .png. Says so and goes on where gnuplot is not installed. Series without points are
// left out. Throws app::OutputError where the folder cannot be written to.
void drawChart(const std::string& folder, const std::string& name, const Chart& chart);

// Writes the script, has gnuplot draw the pictures and removes the script. Where gnuplot is not installed or ends with
// a fault it says so and goes on. Throws app::OutputError where the script cannot be written or, as on a full disk, a
// picture is cut, which gnuplot does not tell.
void runGnuplot(const std::string& script, const std::string& text, const std::vector<std::string>& pictures);

}  // namespace bench
