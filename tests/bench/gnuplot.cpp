#include "tests/bench/gnuplot.h"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/files/errors.h"
#include "app/files/output_file.h"

namespace bench {
namespace {

// Whether an SVG or PNG picture has its end.
bool isWholePicture(const std::string& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  constexpr std::streamoff kEnd = 32;  // bytes; both endings are shorter
  const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : 0;
  if (size <= kEnd) return false;
  std::string end(static_cast<std::size_t>(kEnd), 0);
  stream.seekg(size - kEnd);
  stream.read(end.data(), kEnd);
  return end.find(file.ends_with(".svg") ? "</svg>" : "IEND") != std::string::npos;
}

}  // namespace

void runGnuplot(const std::string& script, const std::string& text, const std::vector<std::string>& pictures) {
  constexpr int kNoSuchProgram = 127;  // of the shell
  app::writeFile(script, text);
  std::fflush(stdout);
  const int status = std::system(("gnuplot '" + script + "' 2>&1").c_str());
  std::error_code ignored;
  std::filesystem::remove(script, ignored);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  for (const std::string& picture : pictures) {
    if (code == kNoSuchProgram)
      std::printf("no chart %s: gnuplot is not installed; install it and run this again\n", picture.c_str());
    else if (code != 0)
      std::printf("no chart %s: gnuplot failed, by what it says above\n", picture.c_str());
    else if (!isWholePicture(picture))
      throw app::OutputError(picture, "could not be written whole by gnuplot", "make room, or choose another folder");
  }
}

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
