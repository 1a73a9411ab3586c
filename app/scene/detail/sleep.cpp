#include "app/scene/detail/sleep.h"

namespace app {

bool maySleep(const sim::SimParams& params, double step, double time, Actor& actor) {
  posePins(actor.pins, actor.pose, actor.previous_pose, time, step, actor.pinned);
  return sim::maySleep(params, {actor.roots, actor.ellipsoids, time, {}, actor.pinned}, step, actor.hair, actor.sleep);
}

}  // namespace app
