#include "app/scene/sleep.h"

#include <algorithm>

#include "app/scene/frame_stats.h"

namespace app {

namespace {

void gather(const Actor& actor, const sim::HairPart& part, PartHair& hair) {
  sim::gatherPart(part, actor.hair, hair.hair);
  hair.roots.clear();
  for (const int column : part.columns) hair.roots.push_back(actor.roots[column]);
  pinsOfPart(part, actor.pinned, hair.pins);
}

}  // namespace

Sleepers sleepersOf(const sim::SimParams& params, double step, double time, Actor& actor) {
  const std::vector<sim::HairPart>& parts = actor.haircut->parts;
  posePins(actor.pins, actor.pose, actor.previous_pose, time, step, actor.pinned);
  // Bundles of different parts meet when hair collides with itself: then they sleep together or not at all.
  if (parts.empty() || params.self_collide || actor.coarse.active) {
    for (PartHair& part : actor.part_hairs) part.sleep.asleep = false;
    actor.sleep.asleep =
        sim::maySleep(params, {actor.roots, actor.ellipsoids, time, {}, actor.pinned}, step, actor.hair, actor.sleep);
    return {actor.sleep.asleep, 1};
  }
  actor.part_hairs.resize(parts.size());
  Sleepers sleepers{0, static_cast<int>(parts.size())};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    PartHair& part = actor.part_hairs[p];
    gather(actor, parts[p], part);
    sleepers.asleep +=
        sim::maySleep(params, {part.roots, actor.ellipsoids, time, {}, part.pins}, step, part.hair, part.sleep);
  }
  actor.sleep.asleep = sleepers.all();
  return sleepers;
}

sim::StepReport advanceAwakeParts(const sim::SimParams& params, sim::StepInput input, double step, Actor& actor) {
  sim::StepReport report;
  sim::HairState& whole = actor.hair;
  whole.previous_positions = whole.positions;
  whole.previous_velocities = whole.velocities;
  for (std::size_t p = 0; p < actor.part_hairs.size(); ++p) {
    PartHair& part = actor.part_hairs[p];
    if (part.sleep.asleep) continue;
    const sim::HairPart& source = actor.haircut->parts[p];
    if (!part.context) {
      part.context = std::make_unique<sim::StepContext>(source.mesh, now);
      part.context->refreshGradually(true);
    }
    input.roots = part.roots;
    input.pins = part.pins;
    input.max_work = actor.max_work * source.mesh.vertexCount() / actor.haircut->mesh.vertexCount();
    sim::addPart(sim::advance(source.mesh, params, input, step, *part.context, part.hair), report);
    sim::scatterPart(source, part.hair, whole);
  }
  whole.previous_dt = step;
  return report;
}

}  // namespace app
