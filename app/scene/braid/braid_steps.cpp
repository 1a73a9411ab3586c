// A strand goes x = a sin t across and y = -b sin 2t outwards, a third of a turn behind the next: on the plait's outer
// face strands come from both edges to the middle. At every sixth of a turn, from t = 30 degrees on, the three form a
// triangle; plaits begin and end there.
#include "app/scene/braid/braid_steps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/figure/smoothstep.h"

namespace app {
namespace {

constexpr double kWidth = 3.3;                        // of the plait, in radii of its tie
constexpr double kPeriod = 1.75;                      // m a turn of the strands, in widths
constexpr double kTaper = 0.62;                       // width at the end over that at the tie
constexpr double kTuft = 0.15;                        // share of the tail beyond the second tie
constexpr double kMinTuft = 0.025, kMaxTuft = 0.055;  // m
constexpr double kPinch = 0.55;                       // of the width, that the second tie takes
constexpr double kBegin = 1.1;                        // widths from the tie, after which hair lies as in the plait
constexpr double kMin = 1.5;                          // widths that are left to braid, at least
constexpr int kStepsATurn = 12;
constexpr double kTwist = 0.25;  // of the hair in a strand, over its phase

// In half widths of the plait: amplitudes of the course, half axes of a strand's section.
constexpr double kCourseAcross = 0.55, kCourseOut = 0.42, kHalfAcross = 0.45, kHalfOut = 0.36;

struct Course {
  double width, end, length;  // m: at the tie; from the tie to the second tie; of the tail

  double widthAt(double s) const { return width * (1 - (1 - kTaper) * std::min(s / end, 1.0)); }
  // rad a metre.
  double rateAt(double s) const {
    const double slower = smoothstep(0, 1, (end - s) / (0.4 * widthAt(s)));
    return slower * 2 * std::numbers::pi / (kPeriod * widthAt(s));
  }
  // 0: as in the plait, 1: as thick as wide.
  double roundAt(double s) const { return smoothstep(0, 1, (s - end) / widthAt(end) + 1); }
  // Share of a strand's way from the middle; in the tuft the strands become one.
  double apartAt(double s) const { return 1 - 0.6 * smoothstep(0, 1, (s - end) / (length - end)); }
  // Of the section against that of a plait of full width.
  double sizeAt(double s) const {
    const double off = (s - end) / (0.3 * widthAt(end)), beyond = std::clamp((s - end) / (length - end), 0.0, 1.0);
    return widthAt(s) / width * (1 - kPinch * std::exp(-off * off)) * (1 - 0.5 * beyond * beyond);
  }
};

// m from the tie: evenly in turns, on into the tuft. The second tie is one of them.
std::vector<double> places(const Course& course, int& band_step) {
  std::vector<double> upto{0};
  const auto spread = [&](double to) {
    const double from = upto.back();
    std::vector<double> part;
    for (double s = from; s < to;) part.push_back(s += kPeriod * course.widthAt(s) / kStepsATurn);
    if (part.size() > 1 && part.back() - to > 0.5 * (part.back() - part[part.size() - 2])) part.pop_back();
    const double scale = (to - from) / (part.back() - from);
    for (const double s : part) upto.push_back(from + scale * (s - from));
  };
  spread(course.end);
  band_step = static_cast<int>(upto.size()) - 1;
  spread(course.length);
  return upto;
}

std::vector<double> phases(const Course& course, const std::vector<double>& at) {
  constexpr int kParts = 16;
  std::vector<double> phase{0};
  for (std::size_t k = 1; k < at.size(); ++k) {
    double turned = 0;
    for (int i = 0; i < kParts; ++i) turned += course.rateAt(at[k - 1] + (at[k] - at[k - 1]) * (i + 0.5) / kParts);
    phase.push_back(phase.back() + turned * (at[k] - at[k - 1]) / kParts);
  }
  const double sixths = std::max(3.0, std::round(phase.back() / (std::numbers::pi / 3)));
  const double scale = sixths * std::numbers::pi / 3 / phase.back();
  for (double& t : phase) t = std::numbers::pi / 6 + scale * t;
  return phase;
}

double tuftOf(double length) {
  return std::clamp(kTuft * length, kMinTuft, kMaxTuft);
}

}  // namespace

double shortestBraid(double radius) {
  return kMin * kWidth * radius + kMaxTuft;
}

bool layBraid(double radius, Braid& braid) {
  braid.steps.clear();
  braid.width = kWidth * radius;
  if (!(braid.length >= shortestBraid(radius))) return false;
  const Course course{braid.width, braid.length - tuftOf(braid.length), braid.length};
  const std::vector<double> at = places(course, braid.band_step), phase = phases(course, at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double half = 0.5 * braid.width * course.sizeAt(at[k]), round = course.roundAt(at[k]);
    const double out = kCourseOut + round * (kCourseAcross - kCourseOut),
                 half_out = kHalfOut + round * (kHalfAcross - kHalfOut);
    const double apart = half * course.apartAt(at[k]);
    BraidStep step;
    step.share = static_cast<float>(at[k] / course.length);
    step.hold = static_cast<float>(smoothstep(0, 1, at[k] / (kBegin * braid.width)));
    step.phase = static_cast<float>(phase[k]);
    for (int j = 0; j < kBraidStrands; ++j) {
      const double t = phase[k] + 2 * std::numbers::pi * j / kBraidStrands;
      step.middle[static_cast<std::size_t>(j)] =
          Eigen::Vector2d(apart * kCourseAcross * std::sin(t), -apart * out * std::sin(2 * t)).cast<float>();
    }
    step.half = Eigen::Vector2d(half * kHalfAcross, half * half_out).cast<float>();
    const double twist = kTwist * (phase[k] - phase[0]);
    step.twist = Eigen::Vector2d(std::cos(twist), std::sin(twist)).cast<float>();
    braid.steps.push_back(step);
  }
  braid.band_radius = 0.5 * braid.width * course.sizeAt(course.end);
  return true;
}

}  // namespace app
