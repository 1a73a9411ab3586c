#include "app/scene/edit/cut_stroke.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/edit/carry_hair.h"
#include "app/scene/edit/groom_brush.h"
#include "app/styles/style_shorten.h"

namespace app {

namespace {

constexpr double kCutFatness = 0.02;  // see shortenColumns
constexpr double kNotAsAsked = 0.01;  // m, of a column that stays longer, before it is told

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
  if (!actor.haircut->cut) return;
  const CutStroke stroke = *std::exchange(ownHaircut(actor, demo).cut, std::nullopt);
  if (stroke.after != actor.haircut->mesh.shape.positions) return;
  sim::HairMeshShape shape = actor.haircut->mesh.shape;
  shape.positions = stroke.before;
  std::vector<double> shares = sharesFor(stroke.lengths, shape);
  // Hair from a file may lie in the body.
  const BodyDistance around = actor.spec.hair.empty() ? actor.body->distance : [](const Vec3&) { return 1.0; };
  shortenColumns(around, kCutFatness, shares, shape);
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
                "or part it off",
                1e3 * longer);
  showMessage(text, demo);
}

}  // namespace

void finishCuts(Demo& demo) {
  for (std::size_t i = 0; i < demo.actors.size(); ++i) finishCut(static_cast<int>(i), demo);
}

}  // namespace app
