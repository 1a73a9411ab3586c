#include "app/scene/detail/level_of_detail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "app/scene/detail/sleep.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/view/world_light.h"

namespace app {

namespace {

// Pixels below which an actor is simulated with a coarser mesh; it returns at kReturn times as many.
struct Coarseness {
  double below;
  Resolution resolution;
};
constexpr std::array<Coarseness, 2> kMeshes{{{420, Resolution::kLow}, {240, Resolution::kMinimal}}};
// And of the hair's length: a coarse mesh is off by a share of that, two hundredths of long hair that rubs on
// shoulders.
constexpr double kHairBelow = 150;
constexpr double kReturn = 1.2;
// And below which its steps are so many times as long.
struct Rate {
  double below;
  int span;
};
constexpr std::array<Rate, 3> kRates{{{520, 2}, {380, 4}, {100, 8}}};
// Of the hair's length: what a vertex moves against the head in such a step at most. In longer ones the energy limit
// takes part of what a somersault throws about, and plaits end crumpled.
constexpr double kMostWay = 0.1;

// Pixels from which hair that begins coarse comes to rest as it would near by, with its own mesh: long hair that the
// shoulders turn aside finds another place with another one. Smaller hair shows less of that than it costs to load.
constexpr double kOwnStart = 150;

// m that a figure may move, and the camera with it, before its detail is looked at again.
constexpr double kMargin = 0.3;
constexpr double kFarthestShadow = 30;  // m along the light

// s over which a step's usual cost is averaged.
constexpr double kCostShare = 0.1;

Vec3 headOf(const Actor& actor) {
  return scalpToWorld(actor.body->character, actor.pose).translation();
}

// World, around the figure and its hair. Of a figure that does not go on whatever its clip does: what is not seen is
// not posed.
Eigen::AlignedBox3d boxAround(const Actor& actor) {
  const Character& character = actor.body->character;
  Eigen::AlignedBox3d box;
  for (const Rigid& joint : actor.pose.world) box.extend(joint.translation());
  if (!actor.reach.isEmpty()) box.extend(actor.reach);
  const Vec3 around = Vec3::Constant(std::max(character.scalp.head_height, actor.haircut->mesh.hair_length));
  const Vec3 margin = Vec3::Constant(kMargin);
  return {box.min() - around - margin, box.max() + around + margin};
}

bool below(double size, double limit, bool already) {
  return size < (already ? kReturn * limit : limit);
}

void skip_count(SkipId id, bool skipped, double seconds, Demo& demo) {
  SkipCount& count = demo.stats.skipped[id];
  count.skipped += skipped;
  ++count.of;
  count.seconds += skipped ? seconds : 0;
}

// What the governor is told of a step.
void weighStep(const sim::StepReport& report, const sim::SimParams& params, Actor& actor, FrameStats& stats) {
  const CoarseHair& coarse = actor.coarse;
  const sim::HairMesh& mesh = coarse.active ? coarse.pair->coarse->mesh : actor.haircut->mesh;
  stats.counted_cost += countedCost(mesh.vertexCount(), report);
  stats.step_error += stepError(mesh, params.integrator, coarse.active ? coarse.hair : actor.hair, actor.error_meter);
}

// m, from tip to crown and a little more.
double hairSize(const Actor& actor) {
  return actor.haircut->mesh.hair_length + 2 * actor.body->character.scalp.head_height;
}

// A mesh in use goes on up to its own way back.
void chooseMesh(double size, Demo& demo, Actor& actor) {
  const std::optional<Resolution> before = std::exchange(actor.detail.coarse, std::nullopt);
  if (!demo.scene.skips[kSkipFarMesh]) return;
  bool already = before.has_value();
  const double hair = size * actor.haircut->mesh.hair_length / hairSize(actor);
  for (const Coarseness& mesh : kMeshes) {
    if (below(size, mesh.below, already) && below(hair, kHairBelow, already) &&
        coarsePair(actor, mesh.resolution, demo.asset_cache))
      actor.detail.coarse = mesh.resolution;
    if (before == mesh.resolution) already = false;
  }
}

// Whether all of the actor's hair sleeps through the step.
bool countSleep(double step, double time, Demo& demo, Actor& actor) {
  bool asleep = false;
  if (demo.scene.skips[kSkipSleep]) {
    asleep = maySleep(demo.running, step, time, actor);
  } else {
    wakeAll(actor);
  }
  SkipCount& count = demo.stats.skipped[kSkipSleep];
  count.skipped += asleep;
  ++count.of;
  if (asleep) count.seconds += actor.usual_step;
  return asleep;
}

// m that a vertex moved against the head in a step of the clock, of late.
double largestWay(const Actor& actor) {
  const auto head = static_cast<std::size_t>(actor.body->character.head_joint);
  const Vec3 carried = actor.pose.world[head].translation() - actor.previous_pose.world[head].translation();
  double largest = 0;
  for (std::size_t v = 0; v < actor.previous_positions.size(); ++v)
    largest = std::max(largest, (actor.hair.positions[v] - actor.previous_positions[v] - carried).norm());
  return largest / actor.span;
}

}  // namespace

double projectedSize(const Demo& demo, const Actor& actor) {
  const Vec3 eye = demo.camera.anchor + demo.camera.target + demo.camera.distance * viewBack(demo.camera);
  const double size = hairSize(actor);
  const double distance = std::max((headOf(actor) - eye).norm() - 0.5 * size, 0.1);
  return size * demo.picture_height / (2 * pictureSlope(demo.camera, demo.place) * distance);
}

bool mayBeSeen(const Demo& demo, const Actor& actor) {
  const Vec3 back = viewBack(demo.camera);
  const Vec3 eye = demo.camera.anchor + demo.camera.target + demo.camera.distance * back;
  const Vec3 right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right);
  const double y = pictureSlope(demo.camera, demo.place), x = y * demo.aspect;
  const double to_right = (1 - demo.place.shift) * x, to_left = (1 + demo.place.shift) * x;
  const double to_top = (1 - demo.place.rise) * y, to_bottom = (1 + demo.place.rise) * y;
  // Planes through the eye, normals outwards.
  const std::array<Vec3, 5> planes{back, (right + to_right * back).normalized(), (-right + to_left * back).normalized(),
                                   (up + to_top * back).normalized(), (-up + to_bottom * back).normalized()};
  const render::LightInput light = lightAbout(demo.actors.front(), demo.scene.look.light);
  const Vec3 to_light(light.to_light[0], light.to_light[1], light.to_light[2]);
  const Eigen::AlignedBox3d box = boxAround(actor);
  Vec3 shadow = Vec3::Zero();
  if (light.shadows && to_light.norm() > 1e-6) {
    const Vec3 direction = to_light.normalized();
    const double height = box.max().y() - demo.scene.look.view.ground_height;
    const double length = direction.y() > 1e-3 ? height / direction.y() : kFarthestShadow;
    shadow = -std::clamp(length, 0.0, kFarthestShadow) * direction;
  }
  return std::none_of(planes.begin(), planes.end(), [&](const Vec3& normal) {
    const double nearest = normal.dot(box.center() - eye) - 0.5 * normal.cwiseAbs().dot(box.sizes());
    return nearest + std::min(normal.dot(shadow), 0.0) > 0;
  });
}

void chooseDetail(Demo& demo) {
  const SkipSet& skips = demo.scene.skips;
  for (Actor& actor : demo.actors) {
    SimDetail& detail = actor.detail;
    detail.seen = !skips[kSkipUnseen] || mayBeSeen(demo, actor);
    const double size = projectedSize(demo, actor);
    chooseMesh(size, demo, actor);
    const int before = detail.step_span;
    detail.step_span = 1;
    const double way = largestWay(actor), most_way = kMostWay * actor.haircut->mesh.hair_length;
    for (const Rate& rate : kRates) {
      const bool gentle = rate.span * way <= most_way;
      if (skips[kSkipFarSteps] && gentle && below(size, rate.below, before >= rate.span)) detail.step_span = rate.span;
    }
  }
}

void settleInDetail(double seconds, Demo& demo, Actor& actor) {
  const HaircutPair* pair = actor.detail.coarse ? coarsePair(actor, *actor.detail.coarse, demo.asset_cache) : nullptr;
  const bool own = !pair || projectedSize(demo, actor) >= kOwnStart;
  if (own) settleActor(demo.scene.sim, seconds, actor);
  if (pair) enterCoarse(*pair, actor);
  if (!own) settleActor(demo.scene.sim, seconds, actor);
}

void stepInDetail(double time, Demo& demo, Actor& actor) {
  const double start = now(), step = demo.running.time_step;
  const SkipSet& skips = demo.scene.skips;
  const std::uint64_t moment = actor.steps++;
  const bool within_own_step = actor.ahead > 0;
  skip_count(kSkipFarSteps, within_own_step, actor.usual_step, demo);
  if (within_own_step) {
    --actor.ahead;
    return;
  }
  skip_count(kSkipUnseen, !actor.detail.seen, actor.usual_step, demo);
  if (!actor.detail.seen) {
    // Travel is the one way for a figure to come into view by itself.
    if (actor.playback.loop.kind != LoopKind::kGoOn) {
      advancePlayback(actor.playedClip(), step, actor.playback);
    } else {
      moveActor(step, actor, skips[kSkipPose], skips[kSkipBones]);
    }
    actor.unseen = true;
    demo.stats.seconds[kTimeCharacter] += now() - start;
    return;
  }
  if (actor.unseen) {
    // Steps were not taken where the head went: the hair comes along as it was.
    if (actor.playback.loop.kind != LoopKind::kGoOn) placeActor(actor, false);
    actor.unseen = false;
  }
  const HaircutPair* pair = actor.detail.coarse ? coarsePair(actor, *actor.detail.coarse, demo.asset_cache) : nullptr;
  if (actor.coarse.active && pair != actor.coarse.pair) leaveCoarse(actor);
  if (!actor.coarse.active && pair) enterCoarse(*pair, actor);
  skip_count(kSkipFarMesh, actor.coarse.active, 0, demo);

  // Up to the next of the moments at which steps of this length end.
  const int span =
      actor.detail.step_span - static_cast<int>(moment % static_cast<std::uint64_t>(actor.detail.step_span));
  const bool moved = moveActor(span * step, actor, skips[kSkipPose], skips[kSkipBones]);
  skip_count(kSkipPose, !moved, 0, demo);
  SkipCount& bones = demo.stats.skipped[kSkipBones];
  const std::vector<unsigned char>& needed = actor.body->moving_joints;
  bones.of += static_cast<long>(needed.size());
  if (moved && skips[kSkipBones]) bones.skipped += std::count(needed.begin(), needed.end(), 0);
  actor.span = span;
  actor.ahead = span - 1;
  const sim::SimParams& params = demo.running;
  if (countSleep(span * step, time, demo, actor)) {
    if (!actor.shown_still) actor.previous_positions = actor.hair.positions;
    demo.stats.seconds[kTimeCharacter] += now() - start;
    return;
  }
  const double before = now();
  const sim::StepReport report = simulateActor(params, span * step, time, actor);
  actor.usual_step += kCostShare * (now() - before - actor.usual_step);
  addStep(report, now() - start, demo.stats);
  if (demo.governor.budget > 0) weighStep(report, params, actor, demo.stats);
}

bool nothingMoves(const Demo& demo) {
  if (demo.loading.running.valid() || cutsAreComing(demo)) return false;
  for (const Actor& actor : demo.actors) {
    if (actor.body->parts_coming.valid()) return false;
  }
  if (!demo.requests.empty() || demo.single_steps > 0 || demo.capture.recording || demo.capture.screenshot)
    return false;
  const bool picture_stays = demo.stats.draw.skip_counts.frame.skipped > 0;
  const bool all_still = std::ranges::all_of(demo.actors, [](const Actor& actor) { return actor.shown_still; });
  return demo.scene.skips[kSkipEvents] && picture_stays && (demo.paused || all_still);
}

}  // namespace app
