#include "app/scene/edit/cut_stroke.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/edit/groom_brush.h"
#include "app/styles/style_shorten.h"

namespace app {

namespace {

constexpr double kCutFatness = 0.02;  // see shortenColumns
constexpr double kNotAsAsked = 0.01;  // m, of a column that stays longer, before it is told

// m, from the root to each vertex of a column.
std::vector<double> wayAlong(std::span<const Vec3> column) {
  std::vector<double> way{0};
  for (std::size_t k = 1; k < column.size(); ++k) way.push_back(way.back() + (column[k] - column[k - 1]).norm());
  return way;
}

std::span<const Vec3> columnOf(std::span<const Vec3> positions, const sim::HairMeshShape& shape, int c) {
  return positions.subspan(static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]),
                           static_cast<std::size_t>(shape.columnLength(c)));
}

// Of each column, as long as `lengths` at most.
std::vector<double> sharesFor(std::span<const double> lengths, const sim::HairMeshShape& shape) {
  std::vector<double> shares;
  for (int c = 0; c < shape.columnCount(); ++c)
    shares.push_back(
        std::min(1.0, lengths[static_cast<std::size_t>(c)] / wayAlong(columnOf(shape.positions, shape, c)).back()));
  return shares;
}

}  // namespace

std::span<const double> cutLengths(const sim::HairMeshShape& shape, std::optional<CutStroke>& stroke) {
  if (!stroke || stroke->after != shape.positions) {
    stroke = {shape.positions, shape.positions, {}};
    for (int c = 0; c < shape.columnCount(); ++c)
      stroke->lengths.push_back(wayAlong(columnOf(shape.positions, shape, c)).back());
  }
  return stroke->lengths;
}

void followCut(std::span<const double> asked, const sim::HairMeshShape& shape, std::optional<CutStroke>& stroke) {
  for (std::size_t c = 0; c < asked.size(); ++c) stroke->lengths[c] = std::min(stroke->lengths[c], asked[c]);
  stroke->after = shape.positions;
}

namespace {

void finishCut(int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  if (!actor.haircut->cut || actor.haircut->cut->after != actor.haircut->mesh.shape.positions) return;
  const CutStroke stroke = *actor.haircut->cut;
  sim::HairMeshShape shape = actor.haircut->mesh.shape;
  shape.positions = stroke.before;
  std::vector<double> shares = sharesFor(stroke.lengths, shape);
  const std::vector<double> asked = shares;
  shortenColumns(actor.body->distance, kCutFatness, shares, shape);
  reshapeHair(shape.positions, index, demo);
  actor.hair.memory.material = {};  // gravity is balanced anew in the next step: what balanced longer hair is far off
  double longer = 0;
  for (int c = 0; c < shape.columnCount(); ++c)
    longer = std::max(
        longer, wayAlong(columnOf(shape.positions, shape, c)).back() - stroke.lengths[static_cast<std::size_t>(c)]);
  if (longer < kNotAsAsked) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "some hair stays %.0f mm longer than the ring: beside longer hair it would be flat; cut that as well, "
                "or split it off",
                1e3 * longer);
  showMessage(text, demo);
}

}  // namespace

void finishCuts(Demo& demo) {
  for (std::size_t i = 0; i < demo.actors.size(); ++i) finishCut(static_cast<int>(i), demo);
}

void carryWithShape(std::span<const Vec3> before, Actor& actor) {
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  const Rigid head = scalpToWorld(actor.body->character, actor.pose);
  std::vector<Vec3> off;  // m, world: of moving hair from where it hung at rest
  for (std::size_t v = 0; v < before.size(); ++v) off.push_back(actor.hair.positions[v] - head * before[v]);
  for (int c = 0; c < shape.columnCount(); ++c) {
    const auto first = static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(c)]);
    const std::vector<double> was = wayAlong(columnOf(before, shape, c)),
                              is = wayAlong(columnOf(shape.positions, shape, c));
    std::size_t segment = 1;
    for (std::size_t k = 1; k < is.size(); ++k) {
      while (segment + 1 < was.size() && was[segment] < is[k]) ++segment;
      const double within = std::min(1.0, (is[k] - was[segment - 1]) / std::max(1e-9, was[segment] - was[segment - 1]));
      const Vec3 &near = off[first + segment - 1], &far = off[first + segment];
      actor.hair.positions[first + k] = head * shape.positions[first + k] + near + within * (far - near);
    }
  }
  actor.hair.previous_dt = 0;
  actor.previous_positions = actor.hair.positions;
  actor.shown_still = false;
}

}  // namespace app
