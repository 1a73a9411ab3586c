#include "app/scene/detail/governor.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

constexpr double kWindow = 0.5;  // simulated s between decisions; two of them see a walk's cycle
constexpr double kFirstWindow = 0.15;
constexpr int kMinFrames = 8;
// After a change solves begin with no earlier solutions to start from: steps, and s, that say little.
constexpr double kSettleSteps = 30, kSettle = 0.1;
constexpr double kOver = 1.04;      // times the budget: mean of two windows from which a coarser rung is taken
constexpr double kFarOver = 1.25;   // of one window
constexpr double kFitsDown = 0.98;  // predicted share of the budget that a coarser rung must fit in
constexpr double kFitsUp = 0.90;    // and a finer one
constexpr double kBackoff = 1, kMaxBackoff = 32;               // s before a climb
constexpr double kSoon = 8;                                    // s
constexpr double kMinSteepness = 1.03, kMaxLadderError = 1.8;  // times the ladder's word
constexpr double kForgetting = 0.002;                          // a window

double steepness(int rung, const Governor& governor) {
  if (rung < 0) return 1;  // nothing is finer
  if (governor.steepness[rung] > 0) return governor.steepness[rung];
  return ladder()[rung + 1].cost / ladder()[rung].cost;
}

// Cost of a simulated second at another rung, from that at the present one.
double predictedAt(int rung, double present, const Governor& governor) {
  for (int k = governor.rung; k < rung; ++k) present *= steepness(k, governor);
  for (int k = governor.rung; k > rung; --k) present /= steepness(k - 1, governor);
  return present;
}

int finestWithin(double most, double present, const Governor& governor) {
  int best = 0;
  for (int k = 0; k < static_cast<int>(ladder().size()); ++k) {
    if (predictedAt(k, present, governor) <= most) best = k;
  }
  return best;
}

void changeTo(int rung, double present, double shown_per_frame, Governor& governor) {
  const double predicted = predictedAt(rung, present, governor);
  governor.left_rung = governor.rung;
  governor.left_cost = rung == governor.rung + 1 ? present : 0;
  governor.rung = rung;
  governor.predicted_cost = predicted * shown_per_frame;
  governor.last_window = 0;
  governor.settle = std::max(kSettle, kSettleSteps / ladder()[rung].steps_per_second);
  governor.since_change = 0;
  ++governor.changes;
}

// What a climb really did to the cost, for the next time it is considered. Descents teach nothing: the load that forced
// them has changed the cost as well.
void learn(double present, Governor& governor) {
  if (governor.left_cost <= 0) return;
  const int below = governor.left_rung;
  const double word = ladder()[below + 1].cost / ladder()[below].cost, ratio = present / governor.left_cost;
  governor.steepness[below] =
      std::max(kMinSteepness, std::clamp(ratio, word / kMaxLadderError, word * kMaxLadderError));
  governor.left_cost = 0;
}

// What was learned was learned under the load of its time: slowly back to the ladder's word.
void forget(Governor& governor) {
  double& learned = governor.steepness[governor.rung];
  if (learned <= 0) return;
  const double word = ladder()[governor.rung + 1].cost / ladder()[governor.rung].cost;
  learned += kForgetting * (word - learned);
}

// A climb that is taken back soon lets the next one wait; long calm makes up for it.
void judgeLastChange(Governor& governor) {
  const bool taken_back = governor.changes > 0 && governor.rung > governor.left_rung && governor.since_change < kSoon;
  governor.backoff = std::clamp(governor.backoff * (taken_back ? 2 : 0.5), kBackoff, kMaxBackoff);
}

}  // namespace

void setBudget(double seconds, Governor& governor) {
  const bool was_off = governor.budget <= 0;
  governor.budget = std::isfinite(seconds) ? std::max(0.0, seconds) : 0;
  if (was_off) governor.rung = defaultRung();
  governor.window = {};
  governor.last_window = 0;
  governor.left_cost = 0;
  governor.calibrated = false;
  governor.over_budget = false;
  governor.backoff = kBackoff;
  governor.since_change = 0;
  governor.settle = kSettle;
}

bool observe(const FrameCost& frame, Governor& governor) {
  if (governor.budget <= 0) return false;
  governor.since_change += frame.shown;
  if (governor.settle > 0) {
    governor.settle -= frame.simulated;
    return false;
  }
  Governor::Window& window = governor.window;
  window.shown += frame.shown;
  window.simulated += frame.simulated;
  window.cost += frame.cost;
  window.error += frame.error * frame.simulated;
  ++window.frames;
  if (window.simulated < (governor.calibrated ? kWindow : kFirstWindow) || window.frames < kMinFrames) return false;

  const double present = window.cost / window.simulated;
  const double per_frame = window.shown / window.frames;
  const double budget = governor.budget / std::max(per_frame, 1e-9);  // of a simulated second
  governor.measured_cost = present * per_frame;
  governor.measured_error = window.error / window.simulated;
  const double mean = governor.last_window > 0 ? 0.5 * (present + governor.last_window) : present;
  const bool two = governor.last_window > 0;
  governor.last_window = present;
  window = {};
  const int finest = static_cast<int>(ladder().size()) - 1;
  if (!governor.calibrated) {
    governor.calibrated = true;
    const int rung = finestWithin(kFitsUp * budget, present, governor);
    governor.predicted_cost = governor.measured_cost;
    governor.over_budget = rung == 0 && predictedAt(0, present, governor) > kOver * budget;
    if (rung == governor.rung) return false;
    changeTo(rung, present, per_frame, governor);
    return true;
  }
  if ((two && mean > kOver * budget) || present > kFarOver * budget) {
    learn(mean, governor);
    governor.over_budget = governor.rung == 0;
    if (governor.rung == 0) return false;
    judgeLastChange(governor);
    changeTo(std::min(governor.rung - 1, finestWithin(kFitsDown * budget, mean, governor)), mean, per_frame, governor);
    return true;
  }
  if (!two) return false;
  learn(mean, governor);
  governor.over_budget = false;
  if (governor.rung < finest) forget(governor);
  if (governor.rung == finest || governor.since_change < governor.backoff) return false;
  if (predictedAt(governor.rung + 1, std::max(mean, present), governor) > kFitsUp * budget) return false;
  changeTo(governor.rung + 1, mean, per_frame, governor);
  return true;
}

sim::SimParams governed(const sim::SimParams& params, const Governor& governor) {
  if (governor.budget <= 0) return params;
  const Rung& rung = ladder()[governor.rung];
  sim::SimParams taken = params;
  taken.integrator = rung.integrator;
  taken.time_step = 1 / rung.steps_per_second;
  taken.tolerance = rung.tolerance;
  taken.max_iterations = std::min(params.max_iterations, rung.max_iterations);
  // As much time as the person's own step would be allowed to make up.
  const double most = params.max_steps_per_frame * params.time_step * rung.steps_per_second;
  taken.max_steps_per_frame = std::max(1, static_cast<int>(std::ceil(most - 1e-9)));
  return taken;
}

double predictedError(const Governor& governor) {
  return ladder()[governor.rung].error;
}

std::string rungName(const Governor& governor) {
  return ladder()[governor.rung].name;
}

}  // namespace app
