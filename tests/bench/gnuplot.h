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

}  // namespace bench
