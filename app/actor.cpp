#include "app/actor.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "app/errors.h"
#include "app/frame_stats.h"
#include "app/hair_file.h"
#include "app/sim_to_render.h"

namespace app {

namespace {

// Air drag while settling, 1/s: strong enough that swings die within the settling time, weak enough that the hair still
// falls.
constexpr double kSettlingDrag = 12;

// Never the same twice in a process: the renderer keeps GPU resources by these, also across scenes opened one after
// another.
std::uint64_t freshId() {
  static std::atomic<std::uint64_t> next{1};
  return next++;
}

LoadedBody& loadBody(const CharacterSpec& spec, Wardrobe& wardrobe) {
  const std::string key = spec.motion + "|" + spec.parts;
  for (const auto& body : wardrobe.bodies) {
    if (body->key == key) return *body;
  }
  auto body = std::make_unique<LoadedBody>();
  body->key = key;
  body->character = loadCharacter(spec.motion, spec.parts);
  body->id = freshId();
  wardrobe.bodies.push_back(std::move(body));
  return *wardrobe.bodies.back();
}

std::string styleTitle(const CharacterSpec& spec) {
  return std::string(sim::styleName(spec.style)) + " " + std::string(sim::resolutionName(spec.resolution));
}

const Haircut& cutHair(const CharacterSpec& spec, LoadedBody& body, Wardrobe& wardrobe) {
  const std::string title = spec.hair.empty() ? styleTitle(spec) : spec.hair;
  const std::string key = spec.hair.empty() ? body.key + "|" + title : title;
  for (const auto& haircut : wardrobe.haircuts) {
    if (haircut->key == key) return *haircut;
  }
  auto haircut = std::make_unique<Haircut>();
  haircut->key = key;
  // Built-in styles alone ask for the distance, and it is a grid that takes time to fill.
  if (spec.hair.empty() && !body.distance) body.distance = restBodyDistance(body.character);
  try {
    haircut->mesh = sim::buildHairMesh(
        spec.hair.empty() ? sim::makeStyle(spec.style, spec.resolution, body.character.scalp, body.distance)
                          : readHairMesh(readText(spec.hair), spec.hair));
  } catch (const sim::MeshError& error) {
    throw InputError(spec.hair.empty() ? "style " + title + " on " + spec.motion : spec.hair, error.place, error.fault,
                     error.mend);
  }
  haircut->faces = renderFaces(haircut->mesh);
  wardrobe.haircuts.push_back(std::move(haircut));
  return *wardrobe.haircuts.back();
}

int findClip(const CharacterSpec& spec, const Character& character) {
  if (spec.clip.empty()) return 0;
  std::string names;
  for (std::size_t c = 0; c < character.clips.size(); ++c) {
    if (character.clips[c].name == spec.clip) return static_cast<int>(c);
    names += (names.empty() ? "" : ", ") + character.clips[c].name;
  }
  throw InputError(spec.motion, "clip '" + spec.clip + "'", "is not in the file", "choose one of " + names);
}

// The playback's pose where the scene stands the figure.
void placedPose(const Actor& actor, Pose& pose) {
  poseAt(actor.body->character.skeleton, actor.playedClip(), actor.playback, pose);
  const Rigid place = Eigen::Translation3d(actor.spec.position) * Eigen::AngleAxisd(actor.spec.heading, Vec3::UnitY());
  for (Rigid& joint : pose.world) joint = place * joint;
}

void followScalp(const Actor& actor, std::vector<sim::Vec3>& roots) {
  const Rigid scalp = scalpToWorld(actor.body->character, actor.pose);
  const sim::HairMeshShape& shape = actor.haircut->mesh.shape;
  roots.resize(shape.columnCount());
  for (int c = 0; c < shape.columnCount(); ++c) roots[c] = scalp * shape.positions[shape.column_first[c]];
}

// What the hair sees in a step that has brought the figure from its previous pose to its present one.
sim::StepInput stepInput(const sim::SimParams& params, double step, double time, Actor& actor) {
  if (params.collider == sim::ColliderKind::kSdf) {
    if (!actor.body->has_parts) actor.body->parts = partDistances(actor.body->character);
    actor.body->has_parts = true;
    posePartDistances(actor.body->parts, actor.pose, actor.previous_pose, step, actor.parts);
  }
  return {actor.roots, actor.ellipsoids, time, actor.parts};
}

}  // namespace

Actor makeActor(const CharacterSpec& spec, const PlaybackSpec& playback, Wardrobe& wardrobe) {
  Actor actor;
  actor.spec = spec;
  LoadedBody& body = loadBody(spec, wardrobe);
  actor.body = &body;
  actor.haircut = &cutHair(spec, body, wardrobe);
  actor.clip = findClip(spec, actor.body->character);
  actor.id = freshId();
  actor.playback.time = spec.clip_offset;
  actor.playback.speed = playback.speed;
  actor.playback.loop = playback.loop;
  actor.playback.blend = playback.blend;
  actor.playback.in_place = spec.in_place;
  // An offset beyond the clip's end starts inside the loop, as if the clip had been playing for so long.
  const double length = actor.playedClip().duration();
  if (playback.loop && length > 0) actor.playback.time = std::fmod(spec.clip_offset, length);
  actor.context = std::make_unique<sim::StepContext>(actor.haircut->mesh, now);
  placeActor(actor, true);
  return actor;
}

void tidy(const std::vector<Actor>& actors, Wardrobe& wardrobe) {
  const auto worn = [&](const auto& entry) {
    return std::any_of(actors.begin(), actors.end(), [&](const Actor& actor) {
      return static_cast<const void*>(actor.body) == entry.get() ||
             static_cast<const void*>(actor.haircut) == entry.get();
    });
  };
  std::erase_if(wardrobe.bodies, [&](const auto& body) { return !worn(body); });
  std::erase_if(wardrobe.haircuts, [&](const auto& haircut) { return !worn(haircut); });
}

void keepMotion(const Actor& from, Actor& actor) {
  actor.playback = from.playback;
  placeActor(actor, true);
}

void placeActor(Actor& actor, bool rest) {
  const bool carried = !rest && !actor.pose.world.empty();
  const Rigid before = carried ? scalpToWorld(actor.body->character, actor.pose) : Rigid::Identity();
  placedPose(actor, actor.pose);
  const Rigid after = scalpToWorld(actor.body->character, actor.pose);
  if (carried) {
    sim::carryAlong(before, after, actor.hair);
  } else {
    actor.hair = sim::restState(actor.haircut->mesh, after);
  }
  actor.previous_pose = actor.pose;
  actor.shown_pose = actor.pose;  // requests may ask for it before the first frame
  actor.previous_positions = actor.hair.positions;
  poseEllipsoids(actor.body->character, actor.pose, actor.pose, 0, actor.ellipsoids);
  followScalp(actor, actor.roots);
}

void moveActor(double step, Actor& actor) {
  std::swap(actor.previous_pose, actor.pose);
  advancePlayback(actor.playedClip(), step, actor.playback);
  placedPose(actor, actor.pose);
  followScalp(actor, actor.roots);
  poseEllipsoids(actor.body->character, actor.pose, actor.previous_pose, step, actor.ellipsoids);
}

sim::StepReport simulateActor(const sim::SimParams& params, double step, double time, Actor& actor) {
  std::copy(actor.hair.positions.begin(), actor.hair.positions.end(), actor.previous_positions.begin());
  actor.last_report = sim::advance(actor.haircut->mesh, params, stepInput(params, step, time, actor), step,
                                   *actor.context, actor.hair);
  return actor.last_report;
}

sim::StepReport stepActor(const sim::SimParams& params, double step, double time, Actor& actor) {
  moveActor(step, actor);
  return simulateActor(params, step, time, actor);
}

void settleActor(const sim::SimParams& params, double seconds, Actor& actor) {
  sim::SimParams thick = params;
  thick.air_drag = std::max(params.air_drag, kSettlingDrag);
  thick.wind_x = thick.wind_y = thick.wind_z = 0;
  const int steps = static_cast<int>(seconds / params.time_step);
  if (steps == 0) return;
  const sim::StepInput input = stepInput(thick, params.time_step, 0, actor);
  for (int i = 0; i < steps; ++i)
    sim::advance(actor.haircut->mesh, thick, input, params.time_step, *actor.context, actor.hair);
  actor.previous_positions = actor.hair.positions;
}

void showActor(double fraction, Actor& actor) {
  blendPoses(actor.previous_pose, actor.pose, fraction, actor.shown_pose);
  if (blendPositions(actor.previous_positions, actor.hair.positions, fraction, actor.shown_positions)) {
    ++actor.position_revision;
  }
  if (jointMatrices(actor.body->character.skeleton, actor.shown_pose, actor.joint_matrices)) ++actor.pose_revision;
}

}  // namespace app
