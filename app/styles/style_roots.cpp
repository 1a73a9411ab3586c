#include "app/styles/style_roots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace app {
namespace {

constexpr int kHalfSheets = 40;
constexpr int kRows = 33;

// A bare line of scalp this wide shows along the parting.
constexpr double kPartingHalfWidth = 0.0004;  // m

// Lines stand along the parting as thick as these powers of the way to its ends.
constexpr double kGatherAtCrown = 0.4, kGatherBehindFringe = 0.6;
// Lines bend sideways as they leave the parting near the crown, and the middle one sets out the way that the parting
// heads, so that root faces at the crown have room on both sides.
constexpr double kSidewaysAtCrown = 0.65, kSidewaysBehindFringe = 0.3, kAheadAtCrown = 1.3;

struct Landmark {
  double azimuth, elevation;  // degrees; the left side's, mirrored for the right
};

// The hairline from the tip of the hair before the ear over the ear to the nape, seen from the middle of the cranium
// level with the top of the ears. It begins where the line over forehead and temple ends, in about a right angle: root
// faces there have a corner that is neither flat nor reflex.
constexpr std::array<Landmark, 7> kHairline{
    {{66, 0}, {81, 7}, {97, 9.5}, {116, -4}, {136, -20}, {158, -30}, {180, -33}}};
// The same from the middle of the forehead.
constexpr std::array<Landmark, 11> kHairlineWithForehead{{{0.25, 36},
                                                          {19, 34},
                                                          {40, 27.5},
                                                          {57, 17},
                                                          {67, 5},
                                                          {81, 7},
                                                          {97, 9.5},
                                                          {116, -4},
                                                          {136, -20},
                                                          {158, -30},
                                                          {180, -33}}};

// Both ends of the parting: front hairline, slightly left of the middle, or behind the fringe, and crown.
constexpr Landmark kPartingFront{15, 35.2};
constexpr Landmark kPartingBehindFringe{5, 67};
constexpr Landmark kCrown{176, 62};

// The line over forehead and temple, from the parting's front to the tip before the ear, bulges towards these.
constexpr Landmark kForeheadLeft{50, 29};
constexpr Landmark kForeheadRight{-46, 31.5};

Vec3 direction(const Landmark& l) {
  return scalpDirection(l.azimuth, l.elevation);
}

Vec3 slerp(const Vec3& a, const Vec3& b, double t) {
  const double angle = std::acos(std::clamp(a.dot(b), -1.0, 1.0));
  if (angle < 1e-6) return a;
  return (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
}

// Uniform Catmull-Rom through the landmarks; x in [0, 1] runs over the whole hairline.
Landmark hairlineAt(std::span<const Landmark> landmarks, double x) {
  const int last = static_cast<int>(landmarks.size()) - 1;
  const double place = std::clamp(x, 0.0, 1.0) * last;
  const int i = std::min(static_cast<int>(place), last - 1);
  const double t = place - i;
  const auto knot = [&](int k) -> Landmark {
    if (k < 0)
      return {2 * landmarks[0].azimuth - landmarks[1].azimuth, 2 * landmarks[0].elevation - landmarks[1].elevation};
    if (k > last) return {360 - landmarks[last - 1].azimuth, landmarks[last - 1].elevation};
    return landmarks[k];
  };
  const auto blend = [t](double a, double b, double c, double d) {
    return 0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) + t * t * t * (3 * (b - c) + d - a));
  };
  const Landmark a = knot(i - 1), b = knot(i), c = knot(i + 1), d = knot(i + 2);
  return {blend(a.azimuth, b.azimuth, c.azimuth, d.azimuth), blend(a.elevation, b.elevation, c.elevation, d.elevation)};
}

// Points evenly spaced by arc length along a polyline.
std::vector<Vec3> resample(const std::vector<Vec3>& line, int count) {
  std::vector<double> length(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) length[i] = length[i - 1] + (line[i] - line[i - 1]).norm();
  std::vector<Vec3> out(count);
  std::size_t i = 1;
  for (int k = 0; k < count; ++k) {
    const double want = length.back() * k / (count - 1);
    while (i + 1 < line.size() && length[i] < want) ++i;
    const double span = length[i] - length[i - 1];
    const double t = span > 0 ? std::clamp((want - length[i - 1]) / span, 0.0, 1.0) : 0.0;
    out[k] = (1 - t) * line[i - 1] + t * line[i];
  }
  return out;
}

// The hairline's points for one side (side = 1 left, -1 right), evenly spaced from its front to the nape.
std::vector<Vec3> hairlineDirections(const Scalp& scalp, double side, bool fringe) {
  const std::span<const Landmark> landmarks =
      fringe ? std::span<const Landmark>(kHairlineWithForehead) : std::span<const Landmark>(kHairline);
  std::vector<Vec3> fine(121);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const Landmark l = hairlineAt(landmarks, static_cast<double>(i) / (fine.size() - 1));
    fine[i] = skinPoint(scalp, scalpDirection(side * l.azimuth, l.elevation));
  }
  std::vector<Vec3> out = resample(fine, kHalfSheets + 1);
  for (Vec3& p : out) p = (p - scalp.center).normalized();
  return out;
}

// How much of the parting is left (1 at its front, 0 at the crown) where each line begins. Lines gather towards the
// crown and a fringe, as they do around the end of any slit when they are to leave it sideways.
std::vector<double> leftOfParting(bool fringe) {
  constexpr int kSteps = 16;  // a line
  std::vector<double> left(kHalfSheets + 1, 0.0);
  if (!fringe) {
    for (int i = 0; i <= kHalfSheets; ++i)
      left[i] = std::pow(1 - static_cast<double>(i) / kHalfSheets, 1 + kGatherAtCrown);
    return left;
  }
  for (int i = kHalfSheets - 1; i >= 0; --i) {
    left[i] = left[i + 1];
    for (int k = 0; k < kSteps; ++k) {
      const double q = (i * kSteps + k + 0.5) / (kHalfSheets * kSteps);
      left[i] += std::pow(1 - q, kGatherAtCrown) * std::pow(q, kGatherBehindFringe);
    }
  }
  const double whole = left[0];
  for (double& l : left) l /= whole;
  return left;
}

// One bank of the parting, from the front to the crown, where both banks meet.
std::vector<Vec3> bankDirections(const Scalp& scalp, const Vec3& front, double side, bool fringe) {
  const Vec3 crown = direction(kCrown);
  const Vec3 across = side * crown.cross(front).normalized();
  const std::vector<double> left = leftOfParting(fringe);
  std::vector<Vec3> out(kHalfSheets + 1);
  for (int i = 0; i <= kHalfSheets; ++i) {
    const Vec3 middle = slerp(front, crown, 1 - left[i]);
    const double width = kPartingHalfWidth * std::min(1.0, left[i] / 0.05);
    out[i] = (middle + across * (width / scalp.radiusAt(middle))).normalized();
  }
  return out;
}

// Lets the inner points of one half settle between their neighbours, so that lines leave the parting sideways and
// spread evenly. The parting, the hairline, the forehead line and the middle line (lines 0 and kHalfSheets) stay.
void settle(std::vector<std::vector<Vec3>>& half) {
  for (int sweep = 0; sweep < 40; ++sweep) {
    for (int s = 1; s < kHalfSheets; ++s) {
      for (int r = 1; r + 1 < kRows; ++r) {
        const Vec3 mean = half[s - 1][r] + half[s + 1][r] + half[s][r - 1] + half[s][r + 1];
        half[s][r] = (0.4 * half[s][r] + 0.6 * mean.normalized()).normalized();
      }
    }
  }
}

}  // namespace

double FlowLines::backness(int sheet) const {
  const int middle = sheets / 2;
  return 1.0 - static_cast<double>(std::abs(sheet - middle)) / middle;
}

Vec3 scalpDirection(double azimuth, double elevation) {
  const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

Vec3 skinPoint(const Scalp& scalp, const Vec3& direction) {
  return scalp.center + direction.normalized() * scalp.radiusAt(direction);
}

FlowLines traceFlowLines(const Scalp& scalp, bool fringe) {
  FlowLines lines{2 * kHalfSheets + 1, kRows, {}};
  lines.points.resize(static_cast<std::size_t>(lines.sheets) * lines.rows);
  const Vec3 front = direction(fringe ? kPartingBehindFringe : kPartingFront);
  for (const double side : {1.0, -1.0}) {
    const std::vector<Vec3> bank = bankDirections(scalp, front, side, fringe),
                            hairline = hairlineDirections(scalp, side, fringe);
    const Vec3 across = side * direction(kCrown).cross(front).normalized();
    // How far the middle line's way to the nape lies beside the way that the parting heads.
    const double astray = across.dot(slerp(bank.back(), hairline.back(), 0.4));
    const Vec3 forehead = direction(side > 0 ? kForeheadLeft : kForeheadRight);
    std::vector<std::vector<Vec3>> half(kHalfSheets + 1, std::vector<Vec3>(kRows));
    for (int s = 0; s <= kHalfSheets; ++s) {
      const double q = static_cast<double>(s) / kHalfSheets;
      const double sideways =
          kSidewaysAtCrown * q * std::sqrt(1 - q) + (fringe ? kSidewaysBehindFringe * (1 - q) * std::sqrt(q) : 0.0);
      const Vec3 between =
          (slerp(bank[s], hairline[s], 0.4) + sideways * across - kAheadAtCrown * q * q * q * astray * across)
              .normalized();
      const Vec3 bend = fringe ? between : slerp(forehead, between, std::min(1.0, q / 0.35));
      for (int r = 0; r < kRows; ++r) {
        const double t = static_cast<double>(r) / (kRows - 1);
        half[s][r] = slerp(slerp(bank[s], bend, t), slerp(bend, hairline[s], t), t);
      }
    }
    settle(half);
    for (int s = 0; s <= kHalfSheets; ++s) {
      for (Vec3& d : half[s]) d = skinPoint(scalp, d);
      const std::vector<Vec3> even = resample(half[s], kRows);
      const int sheet = side > 0 ? s : 2 * kHalfSheets - s;
      // A chord between two skin points runs under the skin: put the samples back on it.
      for (int r = 0; r < kRows; ++r)
        lines.points[static_cast<std::size_t>(sheet) * kRows + r] = skinPoint(scalp, even[r] - scalp.center);
    }
  }
  return lines;
}

}  // namespace app
