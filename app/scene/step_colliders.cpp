#include "app/scene/step_colliders.h"

#include "app/figure/body_sdf.h"
#include "app/scene/attachments.h"

namespace app {

namespace {

// Signed distances of the parts that no ellipsoids fit, beside what is worn. Returns the ellipsoids that fit.
std::span<const sim::Ellipsoid> addUnfitParts(double step, Actor& actor) {
  for (const PartDistance& part : actor.body->unfit_parts)
    posePartDistance(part, actor.pose, actor.previous_pose, step, actor.worn_distances.emplace_back());
  actor.fitting_ellipsoids.clear();
  for (std::size_t k = 0; k < actor.ellipsoids.size(); ++k)
    if (!actor.body->character.ellipsoids[k].by_distances) actor.fitting_ellipsoids.push_back(actor.ellipsoids[k]);
  return actor.fitting_ellipsoids;
}

}  // namespace

sim::StepInput stepInput(const sim::SimParams& params, double step, double time, Actor& actor) {
  if (params.collider == sim::ColliderKind::kSdf) {
    LoadedBody& body = *actor.body;
    if (!body.has_parts && !body.parts_coming.valid()) {
      body.parts = partDistances(body.character);
      body.has_parts = true;
    }
    posePartDistances(body.parts, actor.pose, actor.previous_pose, step, actor.parts);
  }
  poseAttachments(step, actor);
  posePins(actor.pins, actor.pose, actor.previous_pose, time, step, actor.pinned);
  std::span<const sim::Ellipsoid> ellipsoids = actor.ellipsoids;
  if (!actor.body->unfit_parts.empty() && (params.collider != sim::ColliderKind::kSdf || actor.parts.empty()))
    ellipsoids = addUnfitParts(step, actor);
  return {actor.roots, ellipsoids, time, actor.parts, actor.pinned, actor.max_work, actor.worn_distances};
}

}  // namespace app
