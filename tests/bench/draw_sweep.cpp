#include "tests/bench/draw_sweep.h"

#include <algorithm>
#include <cmath>

#include "render/gl/driver.h"
#include "tests/bench/cpu_clock.h"

namespace bench {
namespace {

constexpr double kMuchSlower = 3;     // times the default
constexpr double kEqualTimes = 1.02;  // repeated runs differ by as much
constexpr double kAlikeBlocks = 1.1;  // times as large an error of blocks does not show

double rankedTime(const DrawnFrame& frame) {
  return render::rasterizesInSoftware() ? frame.processor : frame.wall;
}

// What the reference's own error adds to another one, as both are independent: sqrt(e^2 + own^2) - e.
double addedBy(const PictureError& own, const PictureError& error) {
  return std::hypot(error.rms, own.rms) - error.rms;
}

void markDrawFront(DrawSweep& sweep) {
  for (DrawPoint& p : sweep.points) {
    p.on_front = std::none_of(sweep.points.begin(), sweep.points.end(), [&](const DrawPoint& q) {
      return q.error.rms <= p.error.rms + addedBy(sweep.reference.own, p.error) && kEqualTimes * q.time < p.time;
    });
  }
}

}  // namespace

DrawSweep sweepDrawing(DrawStage& stage, const std::vector<DrawSetting>& settings, int runs) {
  DrawSweep sweep{stage.scene(), stage.reference(), {}};
  std::vector<std::vector<double>> walls(settings.size()), processors(settings.size());
  for (const DrawSetting& setting : settings) sweep.points.push_back({setting, 0, 0, 0, {}, 0, false});
  stage.draw(settings.front());  // compiles what draws
  for (int run = 0; run < runs; ++run) {
    for (std::size_t k = 0; k < settings.size(); ++k) {
      if (run > 0 && processors[k].front() > kMuchSlower * processors.front().front()) continue;
      const DrawnFrame frame = stage.draw(settings[k]);
      walls[k].push_back(frame.wall);
      processors[k].push_back(frame.processor);
      if (run > 0) continue;
      sweep.points[k].error = differenceOf(frame.picture, sweep.reference.picture);
      sweep.points[k].strands = frame.strands;
    }
  }
  for (std::size_t k = 0; k < settings.size(); ++k) {
    DrawPoint& point = sweep.points[k];
    point.wall = 1e3 * medianOf(walls[k]);
    point.processor = 1e3 * medianOf(processors[k]);
    point.time = 1e3 * std::ranges::min(render::rasterizesInSoftware() ? processors[k] : walls[k]);
  }
  markDrawFront(sweep);
  return sweep;
}

bool noWorse(const PictureError& error, const PictureError& than, const PictureError& own) {
  return error.rms <= than.rms + addedBy(own, than) && error.blocks <= kAlikeBlocks * than.blocks;
}

DrawLag lagOfDefault(const DrawSweep& sweep) {
  const DrawPoint& standard = sweep.points.front();
  DrawLag lag{1, &standard};
  for (const DrawPoint& point : sweep.points) {
    if (!noWorse(point.error, standard.error, sweep.reference.own)) continue;
    if (const double ratio = standard.time / point.time; ratio > lag.ratio) lag = {ratio, &point};
  }
  return lag;
}

DrawLag confirmedLag(DrawStage& stage, const DrawSweep& sweep, int rounds) {
  const DrawPoint& standard = sweep.points.front();
  DrawLag lag = lagOfDefault(sweep);
  if (lag.point == &standard) return lag;
  lag.ratio = confirmedRatio(stage, standard.setting, lag.point->setting, rounds);
  return lag.ratio > 1 ? lag : DrawLag{1, &standard};
}

double confirmedRatio(DrawStage& stage, const DrawSetting& slow, const DrawSetting& fast, int rounds) {
  std::vector<double> ratios;
  for (int round = 0; round < rounds; ++round)
    ratios.push_back(rankedTime(stage.draw(slow)) / rankedTime(stage.draw(fast)));
  return medianOf(ratios);
}

}  // namespace bench
