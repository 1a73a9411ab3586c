#include "app/scene/detail/deadline.h"

#include <algorithm>
#include <cmath>

namespace app {
namespace {

constexpr double kLearning = 0.05;  // share of a new frame in what is learned

void learn(double value, double& average) {
  average += average > 0 ? kLearning * (value - average) : value;
}

}  // namespace

int affordableSteps(int wanted, Deadline& deadline) {
  if (deadline.seconds <= 0) return wanted;
  deadline.left = deadline.seconds / deadline.seconds_per_unit;
  if (deadline.usual <= 0) return wanted;
  return std::clamp(static_cast<int>(std::min(1e6, deadline.left / deadline.usual)), std::min(1, wanted), wanted);
}

double workOfStep(int vertices, long vertices_to_come, const Deadline& deadline) {
  if (deadline.seconds <= 0) return INFINITY;
  return std::max(0.0, deadline.left) * vertices / static_cast<double>(std::max(1L, vertices_to_come));
}

void observeWork(int steps, double units, double seconds, Deadline& deadline) {
  if (deadline.seconds <= 0 || steps <= 0 || units <= 0) return;
  learn(units / steps, deadline.usual);
  if (!deadline.counted) learn(seconds / units, deadline.seconds_per_unit);
}

}  // namespace app
