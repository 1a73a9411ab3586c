#include "app/scene/edit/cut_stroke.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <utility>

#include "app/files/errors.h"
#include "app/scene/demo.h"
#include "app/scene/edit/carry_hair.h"
#include "app/scene/edit/groom_brush.h"

namespace app {

namespace {

constexpr double kCutFatness = 0.02;  // see shortenColumns
constexpr double kNotAsAsked = 0.01;  // m, of a column that stays longer, before it is told
constexpr int kVertexSweeps = 30000;  // a frame: vertices times sweeps, some milliseconds

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

void tellWhatStays(const CutStroke& stroke, const sim::HairMeshShape& shape, Demo& demo) {
  double longer = 0;
  for (int c = 0; c < shape.columnCount(); ++c)
    longer = std::max(
        longer, wayAlong(columnOf(shape.positions, shape, c)).back() - stroke.lengths[static_cast<std::size_t>(c)]);
  if (longer < kNotAsAsked) return;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "some hair stays %.0f mm longer than the ring asks: beside longer hair it would be flat; cut the longer hair "
      "too, or part it off",
      1e3 * longer);
  showMessage(text, demo);
}

void endCut(Actor& actor, Demo& demo) {
  if (!actor.haircut->cut) return;
  CutStroke stroke = *std::exchange(ownHaircut(actor, demo).cut, std::nullopt);
  sim::HairMeshShape shape = actor.haircut->mesh.shape;
  if (stroke.after != shape.positions) return;
  shape.positions = stroke.before;
  std::vector<double> shares = sharesFor(stroke.lengths, shape);
  // Hair from a file may lie in the body.
  const BodyDistance around = actor.spec.hair.empty() ? actor.body->distance : [](const Vec3&) { return 1.0; };
  actor.coming_cut.reset(
      new CutFinish{std::move(stroke), Shortening(around, kCutFatness, std::move(shares), std::move(shape))});
}

void work(int sweeps, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  if (!actor.coming_cut) return;
  const bool other = actor.coming_cut->stroke.after != actor.haircut->mesh.shape.positions;
  if (!other && !actor.coming_cut->shortening.work(sweeps)) return;
  const std::unique_ptr<CutFinish> finish = std::move(actor.coming_cut);
  if (other) return;
  try {
    reshapeHair(finish->shortening.shape().positions, index, demo);
    tellWhatStays(finish->stroke, finish->shortening.shape(), demo);
  } catch (const InputError& fault) {
    showMessage(fault.what(), demo);
  }
}

}  // namespace

void endCuts(Demo& demo) {
  for (Actor& actor : demo.actors) endCut(actor, demo);
}

void workOnCuts(Demo& demo) {
  for (std::size_t i = 0; i < demo.actors.size(); ++i)
    work(kVertexSweeps / demo.actors[i].haircut->mesh.vertexCount() + 1, static_cast<int>(i), demo);
}

void finishCuts(Demo& demo) {
  for (std::size_t i = 0; i < demo.actors.size(); ++i) work(std::numeric_limits<int>::max(), static_cast<int>(i), demo);
}

bool cutsAreComing(const Demo& demo) {
  return std::ranges::any_of(demo.actors, [](const Actor& actor) { return actor.coming_cut != nullptr; });
}

}  // namespace app
