#include "app/styles/hair_styles.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/styles/style_comb.h"
#include "app/styles/style_cut.h"
#include "app/styles/style_refine.h"
#include "app/styles/style_roots.h"
#include "app/styles/style_untangle.h"
#include "app/styles/style_weave.h"

namespace app {
namespace {

constexpr double kFatness = 0.10, kFatnessRefined = 0.09;  // of every corner tetrahedron, see cornerFatness
constexpr double kGap = 0.0025;  // m, of every vertex but the roots; further down the coat keeps more by itself
constexpr double kGapBeforeRefining = 0.0042;  // m: layers half-way to the roots find room

constexpr double kOrdinaryHead = 0.23;  // m from chin to crown
constexpr double kMinFatness = 0.03;

Scalp scaledTo(Scalp scalp, double factor) {
  scalp.center *= factor;
  scalp.head_height *= factor;
  for (double& r : scalp.radius) r *= factor;
  return scalp;
}

// The head with its radius averaged over neighbouring directions, `rounds` times, then brought nearer to a ball of
// ordinary size by the share `ball`.
Scalp rounded(Scalp scalp, int rounds, double ball) {
  std::vector<double> next(scalp.radius.size());
  const auto at = [&](int i, int j) {
    return scalp.radius[static_cast<std::size_t>(std::clamp(i, 0, scalp.rows - 1)) * scalp.columns +
                        (j + scalp.columns) % scalp.columns];
  };
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < scalp.rows; ++i) {
      for (int j = 0; j < scalp.columns; ++j) {
        next[static_cast<std::size_t>(i) * scalp.columns + j] =
            (at(i - 1, j) + at(i + 1, j) + at(i, j - 1) + at(i, j + 1) + 2 * at(i, j)) / 6;
      }
    }
    std::swap(scalp.radius, next);
  }
  const auto upper_half = scalp.radius.begin() + static_cast<std::ptrdiff_t>(scalp.rows / 2) * scalp.columns;
  const double mean = std::accumulate(scalp.radius.begin(), upper_half, 0.0) / (upper_half - scalp.radius.begin());
  for (double& r : scalp.radius) r += ball * (mean - r);
  return scalp;
}

// The same roots with stubble.
sim::HairMeshShape shavedTo(double length, int layers, const sim::HairMeshShape& style, const Scalp& scalp,
                            const BodyDistance& body) {
  constexpr double kAlong = 1.2;  // of its way off the scalp: it stands 10 mm high
  sim::HairMeshShape shape;
  shape.root_faces = style.root_faces;
  for (int c = 0; c < style.columnCount(); ++c) {
    const auto root = static_cast<std::size_t>(style.column_first[static_cast<std::size_t>(c)]);
    const Vec3 off = (style.positions[root] - scalp.center).normalized();
    const Vec3 along = (style.positions[root + 1] - style.positions[root]).normalized();
    const Vec3 way = (off + kAlong * along).normalized();
    for (int l = 0; l < layers; ++l) shape.positions.push_back(style.positions[root] + l * length / (layers - 1) * way);
    shape.column_first.push_back(static_cast<int>(shape.positions.size()));
  }
  untangle(body, kFatness, 0, shape);
  return shape;
}

// Leads hair that fell around a post out of the body, as far as its prisms stay fat enough.
void leaveBody(const BodyDistance& body, double fatness, sim::HairMeshShape& shape) {
  constexpr int kRounds = 12;
  sim::HairMeshShape outside = shape;
  for (int round = 0; round < kRounds; ++round)
    if (untangle(body, fatness, kGap, outside) > kMinFatness) shape = outside;
}

}  // namespace

double Scalp::radiusAt(const Vec3& direction) const {
  assert(rows >= 2 && columns >= 3 && radius.size() == static_cast<std::size_t>(rows) * columns);
  const double length = direction.norm();
  assert(length > 0);
  const double polar = std::acos(std::clamp(direction.y() / length, -1.0, 1.0));
  const double azimuth = std::atan2(direction.x(), direction.z());
  const double turn = 2 * std::numbers::pi;
  const double row = polar / std::numbers::pi * (rows - 1);
  const double column = (azimuth < 0 ? azimuth + turn : azimuth) / turn * columns;
  const int i = std::min(static_cast<int>(row), rows - 2);
  const int j = static_cast<int>(column) % columns, k = (j + 1) % columns;
  const double u = row - i, v = column - std::floor(column);
  const auto at = [&](int a, int b) { return radius[static_cast<std::size_t>(a) * columns + b]; };
  return (1 - u) * ((1 - v) * at(i, j) + v * at(i, k)) + u * ((1 - v) * at(i + 1, j) + v * at(i + 1, k));
}

sim::HairMeshShape makeStyle(Style style, Resolution resolution, const Scalp& scalp, const BodyDistance& body) {
  if (style == Style::kShaved) {
    constexpr double kStubble = 0.016 / kOrdinaryHead;
    constexpr int kLayers = 6;
    return shavedTo(kStubble * scalp.head_height, kLayers, makeStyle(Style::kShort, resolution, scalp, body), scalp,
                    body);
  }
  // Hair is cut on a head of ordinary size, where lengths mean what they say, and grown or shrunk with it.
  const double scale = scalp.head_height / kOrdinaryHead;
  const BodyDistance scaled_body = [&](const Vec3& p) { return body(scale * p) / scale; };
  // A head with horns, or a jaw wider than the shoulders, can leave no room for a haircut. Then the hair grows on a
  // rounded head instead, and in the end falls around a post in place of the body rather than be refused.
  const BodyDistance post = [&](const Vec3& p) {
    const Vec3 above = p - scalp.center / scale;
    return Vec3(above.x(), std::max(0.0, above.y()), above.z()).norm() - 0.5 * kOrdinaryHead;
  };
  struct Attempt {
    int rounds;
    double ball;
    const BodyDistance* around;
  };
  const Weave plan = weaveOf(style, resolution);
  sim::HairMeshShape shape;
  for (const Attempt& attempt :
       {Attempt{0, 0, &scaled_body}, Attempt{20, 0, &scaled_body}, Attempt{60, 0.5, &post}, Attempt{60, 1, &post}}) {
    const Scalp head = rounded(scaledTo(scalp, 1 / scale), attempt.rounds, attempt.ball);
    Woven woven = weave(combCoat(style, head, *attempt.around, traceFlowLines(head, hasFringe(style))), plan);
    const bool refining = resolution == Resolution::kUltra;
    const double gap = refining ? kGapBeforeRefining : kGap;
    layFlat(*attempt.around, woven.up, kFatness, gap, woven.shape);
    double fatness = untangle(*attempt.around, kFatness, gap, woven.shape);
    if (refining) {
      woven.shape = refined(woven, head);
      fatness = untangle(*attempt.around, kFatnessRefined, kGap, woven.shape);
    }
    shape = std::move(woven.shape);
    if (fatness <= kMinFatness) continue;
    if (attempt.around == &post) leaveBody(scaled_body, refining ? kFatnessRefined : kFatness, shape);
    break;
  }
  for (Vec3& p : shape.positions) p *= scale;
  return shape;
}

bool hasFringe(Style style) {
  return style != Style::kShaved && kCuts[static_cast<std::size_t>(style)].fringe.has_value();
}

std::optional<Style> parseStyle(std::string_view name) {
  const auto at = std::ranges::find(kStyleNames, name);
  if (at == kStyleNames.end()) return {};
  return static_cast<Style>(at - kStyleNames.begin());
}

std::string_view resolutionName(Resolution resolution) {
  constexpr std::array<std::string_view, 5> kNames{"low", "medium", "high", "ultra", "minimal"};
  return kNames[static_cast<std::size_t>(resolution)];
}

}  // namespace app
