#include "app/scene/detail/draw_governor.h"

#include <algorithm>
#include <cmath>

namespace app {

namespace {

// Cost and error: geometric means over close_up and bust of `hairmesh-bench --draw-pareto`, one run on llvmpipe beside
// other work, in which times of equal work differed by a third. What a rung costs elsewhere the governor learns.
constexpr DrawRung kDrawLadder[] = {
    {"all strands", 1, 1, 1, 1, 1},
    {"70 % of the strands", 0.7, 1.5, 0.7, 0.80, 1.02},
    {"50 % of the strands", 0.5, 2, 0.5, 0.69, 1.03},
    {"35 % of the strands", 0.35, 3, 0.35, 0.54, 1.11},
    {"22 % of the strands", 0.22, 4, 0.22, 0.43, 1.26},
    {"12 % of the strands", 0.12, 6, 0.12, 0.35, 1.63},
};
static_assert(std::size(kDrawLadder) <= kMaxDrawRungs);

constexpr double kGlide = 0.5;           // s from one rung to the next
constexpr double kMaxGlideShare = 0.25;  // of it, in one frame
constexpr int kStart = 3;                // frames that compile shaders and fill the GPU
constexpr double kDrawOver = 1.03;       // times the budget, from which a cheaper rung is taken
constexpr double kDrawFarOver = 2;       // times the budget: fewer frames tell enough
constexpr int kDrawFarFrames = 3;        // so many
constexpr double kDrawFitsUp = 0.88;     // share of the budget that a finer rung's predicted time must fit in
constexpr double kDrawBackoff = 1, kMaxDrawBackoff = 32;  // s before a climb
constexpr double kTakenBack = 8;                          // s
constexpr double kMinRise = 1.02, kMaxOff = 1.8;          // times the ladder's word

int cheapest() {
  return static_cast<int>(drawLadder().size()) - 1;
}

double wordOf(int rung) {
  return kDrawLadder[rung].cost / kDrawLadder[rung + 1].cost;
}

double riseTo(int rung, const DrawGovernor& governor) {
  return governor.rise[rung] > 0 ? governor.rise[rung] : wordOf(rung);
}

double medianOfWindow(const DrawGovernor& governor) {
  std::array<double, DrawGovernor::kWindow> window = governor.window;
  const auto middle = window.begin() + governor.frames / 2;
  std::nth_element(window.begin(), middle, window.begin() + governor.frames);
  return *middle;
}

bool enoughSeen(const DrawGovernor& governor) {
  if (governor.frames == DrawGovernor::kWindow) return true;
  const auto far = [&](double cost) { return cost > kDrawFarOver * governor.budget; };
  return governor.frames >= kDrawFarFrames && governor.rung < cheapest() &&
         std::all_of(governor.window.begin(), governor.window.begin() + governor.frames, far);
}

// What a climb by one rung really did to the cost. Descents teach nothing: the load that forced them has changed the
// cost as well.
void learnRise(DrawGovernor& governor) {
  if (!governor.climbed || governor.left_cost <= 0) return;
  const double word = wordOf(governor.rung), ratio = governor.measured_cost / governor.left_cost;
  governor.rise[governor.rung] = std::max(kMinRise, std::clamp(ratio, word / kMaxOff, word * kMaxOff));
  governor.left_cost = 0;
}

bool changeDrawRung(int rung, DrawGovernor& governor) {
  governor.climbed = rung < governor.rung;
  governor.left_cost = rung == governor.rung - 1 ? governor.measured_cost : 0;
  governor.rung = rung;
  governor.since_change = 0;
  governor.settle = 1;
  ++governor.changes;
  return true;
}

bool stepDown(DrawGovernor& governor) {
  governor.over_budget = governor.rung == cheapest();
  if (governor.over_budget) return false;
  const bool taken_back = governor.climbed && governor.since_change < kTakenBack;
  governor.backoff = std::clamp(governor.backoff * (taken_back ? 2 : 0.5), kDrawBackoff, kMaxDrawBackoff);
  int rung = governor.rung + 1;
  double predicted = governor.measured_cost / riseTo(governor.rung, governor);
  for (; rung < cheapest() && predicted > kDrawOver * governor.budget; ++rung) predicted /= riseTo(rung, governor);
  return changeDrawRung(rung, governor);
}

bool climb(DrawGovernor& governor) {
  int rung = governor.rung;
  double predicted = governor.measured_cost;
  while (rung > 0 && (predicted *= riseTo(rung - 1, governor)) <= kDrawFitsUp * governor.budget) --rung;
  return rung != governor.rung && changeDrawRung(rung, governor);
}

// The value between two rungs, in equal shares.
double glidingValue(double DrawRung::*value, double place) {
  const int from = std::clamp(static_cast<int>(place), 0, cheapest());
  const int to = std::min(from + 1, cheapest());
  const double share = place - from;
  return std::pow(kDrawLadder[from].*value, 1 - share) * std::pow(kDrawLadder[to].*value, share);
}

}  // namespace

std::span<const DrawRung> drawLadder() {
  return kDrawLadder;
}

void setDrawBudget(double seconds, DrawGovernor& governor) {
  const bool was_off = governor.budget <= 0;
  governor.budget = std::isfinite(seconds) ? std::max(0.0, seconds) : 0;
  if (was_off) governor.rung = 0, governor.place = 0;
  governor.frames = 0;
  governor.settle = was_off ? kStart : 0;
  governor.left_cost = 0;
  governor.since_change = 0;
  governor.backoff = kDrawBackoff;
  governor.over_budget = false;
}

void glide(double seconds, DrawGovernor& governor) {
  if (governor.budget <= 0) return;
  const double way = governor.rung - governor.place;
  const double most = std::clamp(seconds / kGlide, 0.0, kMaxGlideShare) * std::max(1.0, std::ceil(std::abs(way)));
  governor.place = std::abs(way) <= most ? governor.rung : governor.place + std::copysign(most, way);
}

bool observeDrawing(double seconds, double cost, DrawGovernor& governor) {
  if (governor.budget <= 0 || !std::isfinite(cost)) return false;
  governor.since_change += std::max(0.0, seconds);
  if (governor.place != governor.rung) return false;
  if (governor.settle > 0) {
    --governor.settle;
    return false;
  }
  governor.window[governor.frames++] = cost;
  if (!enoughSeen(governor)) return false;
  governor.measured_cost = medianOfWindow(governor);
  governor.frames = 0;
  learnRise(governor);
  if (governor.measured_cost > kDrawOver * governor.budget) return stepDown(governor);
  governor.over_budget = false;
  return governor.since_change >= governor.backoff && climb(governor);
}

void governDrawing(const DrawGovernor& governor, render::FrameInput& frame) {
  if (governor.budget <= 0) return;
  const auto share = [&](double DrawRung::*value) { return static_cast<float>(glidingValue(value, governor.place)); };
  frame.view.strand_share *= share(&DrawRung::strands);
  frame.view.segment_error *= share(&DrawRung::segment_error);
  frame.light.shadow_strand_share *= share(&DrawRung::shadow_strands);
}

std::string drawRungName(const DrawGovernor& governor) {
  return kDrawLadder[governor.rung].name;
}

}  // namespace app
