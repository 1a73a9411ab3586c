#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/groom/inspect/groom_inspect.h"
#include "app/groom/inspect/groom_shape.h"
#include "app/groom/inspect/strand_direction.h"

namespace app {

using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {

// The groom with only those strands.
void keepStrands(const std::vector<std::size_t>& kept, Groom& groom) {
  Groom less;
  const auto points = [&](const auto& all, auto& some, std::size_t s) {
    if (all.empty()) return;
    some.insert(some.end(), all.begin() + groom.strand_first[s], all.begin() + groom.strand_first[s + 1]);
  };
  const auto strand = [&](const auto& all, auto& some, std::size_t s) {
    if (!all.empty()) some.push_back(all[s]);
  };
  for (const std::size_t s : kept) {
    points(groom.points, less.points, s);
    points(groom.widths, less.widths, s);
    points(groom.colors, less.colors, s);
    strand(groom.root_uvs, less.root_uvs, s);
    strand(groom.ids, less.ids, s);
    strand(groom.groups, less.groups, s);
    strand(groom.guides, less.guides, s);
    less.strand_first.push_back(static_cast<std::uint32_t>(less.points.size()));
  }
  groom = std::move(less);
}

void dropBad(Groom& groom) {
  const float size = groomSize(groom);
  std::vector<std::size_t> kept;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (strandFault(groom, s, size) == StrandFault::kNone) kept.push_back(s);
  }
  keepStrands(kept, groom);
}

void dropFar(const HeadModel& head, float far, Groom& groom) {
  std::vector<std::size_t> kept;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (groom.pointCount(s) > 0 && std::abs(head.distance(groom.strand(s).front())) <= far) kept.push_back(s);
  }
  keepStrands(kept, groom);
}

void dropAstray(Groom& groom) {
  const std::vector<std::size_t> astray = strandEnds(groom, 0).astray;
  std::vector<std::size_t> kept;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (!std::ranges::binary_search(astray, s)) kept.push_back(s);
  }
  keepStrands(kept, groom);
}

void reverseStrands(Reverse which, Groom& groom) {
  const std::vector<bool> backward =
      which == Reverse::kFound ? backwardStrands(groom) : std::vector<bool>(groom.strandCount(), true);
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    if (!backward[s]) continue;
    const auto turn = [&](auto& all) {
      if (!all.empty()) std::reverse(all.begin() + groom.strand_first[s], all.begin() + groom.strand_first[s + 1]);
    };
    turn(groom.points);
    turn(groom.widths);
    turn(groom.colors);
  }
}

// `count` points evenly along each strand's length; widths and colours with them.
void resample(std::size_t count, Groom& groom) {
  Groom even;
  for (std::size_t s = 0; s < groom.strandCount(); ++s) {
    const std::span<const Vector3f> points = groom.strand(s);
    if (points.empty()) {
      even.strand_first.push_back(static_cast<std::uint32_t>(even.points.size()));
      continue;
    }
    std::vector<float> along{0};
    for (std::size_t p = 1; p < points.size(); ++p) along.push_back(along.back() + (points[p] - points[p - 1]).norm());
    std::size_t before = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const float at = along.back() * static_cast<float>(n) / static_cast<float>(count - 1);
      while (before + 2 < points.size() && along[before + 1] < at) ++before;
      const std::size_t after = std::min(before + 1, points.size() - 1);
      const float gap = along[after] - along[before];
      const float share = gap > 0 ? std::clamp((at - along[before]) / gap, 0.0f, 1.0f) : 0.0f;
      const auto mix = [&](const auto& all, auto& some) {
        if (all.empty()) return;
        const std::size_t first = groom.strand_first[s];
        some.push_back((1 - share) * all[first + before] + share * all[first + after]);
      };
      mix(groom.points, even.points);
      mix(groom.widths, even.widths);
      mix(groom.colors, even.colors);
    }
    even.strand_first.push_back(static_cast<std::uint32_t>(even.points.size()));
  }
  groom.strand_first = std::move(even.strand_first);
  groom.points = std::move(even.points);
  groom.widths = std::move(even.widths);
  groom.colors = std::move(even.colors);
}

// Along the distance's gradient, half a millimetre out of the skin.
void pushOut(const HeadModel& head, Groom& groom) {
  constexpr float kOut = 5e-4f, kStep = 1e-3f;
  for (Vector3f& point : groom.points) {
    for (int round = 0; round < 4; ++round) {
      const float deep = kOut - head.distance(point);
      if (deep <= 0) break;
      Vector3f slope;
      for (int axis = 0; axis < 3; ++axis)
        slope[axis] = (head.distance(point + kStep * Vector3f::Unit(axis)) - head.distance(point)) / kStep;
      const float steep = slope.norm();
      if (!(steep > 0)) break;
      point += deep / steep * slope;
    }
  }
}

}  // namespace

void mendGroom(const GroomMends& mends, const HeadModel* head, Groom& groom) {
  if (mends.drop_bad) dropBad(groom);
  if (mends.drop_astray) dropAstray(groom);
  const auto unit = static_cast<float>(mends.unit);
  for (Vector3f& point : groom.points) point = unit * (mends.axes * point);
  for (float& width : groom.widths) width *= unit * mends.width_scale;
  if (mends.reverse != Reverse::kNone) reverseStrands(mends.reverse, groom);
  if (mends.points > 1) resample(static_cast<std::size_t>(mends.points), groom);
  for (Vector3f& point : groom.points) point = mends.scale * point + mends.move;
  for (float& width : groom.widths) {
    if (mends.width > 0 && !(std::isfinite(width) && width > 0)) width = mends.width;
  }
  if (mends.drop_far > 0 && head) dropFar(*head, mends.drop_far, groom);
  if (mends.push_out && head) pushOut(*head, groom);
}

std::optional<Matrix3f> axesOfUp(std::string_view up) {
  const auto rows = [](float a, float b, float c, float d, float e, float f, float g, float h, float i) {
    Matrix3f matrix;
    matrix << a, b, c, d, e, f, g, h, i;
    return matrix;
  };
  if (up == "y") return Matrix3f(Matrix3f::Identity());
  if (up == "z") return rows(1, 0, 0, 0, 0, 1, 0, -1, 0);
  if (up == "-y") return rows(-1, 0, 0, 0, -1, 0, 0, 0, 1);
  if (up == "-z") return rows(1, 0, 0, 0, 0, -1, 0, 1, 0);
  if (up == "x") return rows(0, -1, 0, 1, 0, 0, 0, 0, 1);
  if (up == "-x") return rows(0, 1, 0, -1, 0, 0, 0, 0, 1);
  return std::nullopt;
}

Matrix3f toldAxes(const GroomHints& hints) {
  return *axesOfUp(hints.up == 'Z' ? "z" : "y");
}

Matrix3f turnedAbout(double degrees) {
  const auto angle = static_cast<float>(degrees * std::numbers::pi / 180);
  Matrix3f matrix = Matrix3f::Identity();
  matrix(0, 0) = matrix(2, 2) = std::round(1e6f * std::cos(angle)) / 1e6f;
  matrix(0, 2) = std::round(1e6f * std::sin(angle)) / 1e6f;
  matrix(2, 0) = -matrix(0, 2);
  return matrix;
}

}  // namespace app
