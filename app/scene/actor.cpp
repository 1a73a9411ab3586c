#include "app/scene/actor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/figure/root_cover.h"
#include "app/files/errors.h"
#include "app/scene/attachments.h"
#include "app/scene/detail/sleep.h"
#include "app/scene/frame_stats.h"
#include "app/scene/hair_from_file.h"
#include "app/scene/haircuts.h"
#include "app/scene/sim_to_render.h"
#include "app/scene/step_colliders.h"
#include "app/styles/tie_ring.h"

namespace app {

namespace {

// Air drag while settling, 1/s: strong enough that swings die within the settling time, weak enough that the hair still
// falls.
constexpr double kSettlingDrag = 12;

// s, after which what the coarse shape lacks at the change-over has faded to a third: slow enough not to be seen.
constexpr double kRemainderTime = 1;

// Joints that skin, ellipsoids or the scalp hang on, and those above them.
std::vector<unsigned char> movingJoints(const Character& character) {
  std::vector<unsigned char> moving(character.skeleton.joints.size(), 0);
  moving[static_cast<std::size_t>(character.head_joint)] = 1;
  for (const BodyEllipsoid& part : character.ellipsoids) moving[static_cast<std::size_t>(part.joint)] = 1;
  for (std::size_t v = 0; v < character.mesh.joints.size(); ++v) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (character.mesh.weights[v][k] > 0) moving[character.mesh.joints[v][k]] = 1;
    }
  }
  for (std::size_t j = moving.size(); j-- > 0;) {
    const int parent = character.skeleton.joints[j].parent;
    if (moving[j] && parent >= 0) moving[static_cast<std::size_t>(parent)] = 1;
  }
  return moving;
}

LoadedBody& loadBody(const CharacterSpec& spec, AssetCache& asset_cache) {
  const std::string key = spec.motion + "|" + spec.parts + "|" + spec.body;
  for (const auto& body : asset_cache.bodies) {
    if (body->key == key) return *body;
  }
  auto body = std::make_unique<LoadedBody>();
  body->key = key;
  body->character = loadCharacter(spec.motion, spec.parts, spec.body);
  body->unfit_parts = unfitPartDistances(body->character);
  body->moving_joints = movingJoints(body->character);
  body->id = freshId();
  for (PartDistance& part : body->unfit_parts) part.id = freshId();
  asset_cache.bodies.push_back(std::move(body));
  return *asset_cache.bodies.back();
}

// Four a face: of a triangle the first one twice.
std::vector<Vec3> rootCorners(const sim::HairMeshShape& shape) {
  std::vector<Vec3> corners;
  for (const sim::RootFace& face : shape.root_faces) {
    for (int k = 0; k < 4; ++k) {
      const int column = face.columns[static_cast<std::size_t>(k % face.corner_count)];
      corners.push_back(
          shape.positions[static_cast<std::size_t>(shape.column_first[static_cast<std::size_t>(column)])]);
    }
  }
  return corners;
}

const ScalpCover& coverScalp(const LoadedBody& body, const Haircut& haircut, AssetCache& asset_cache) {
  std::vector<Vec3> roots = rootCorners(haircut.mesh.shape);
  for (const auto& scalp : asset_cache.covers) {
    if (scalp->body_id == body.id && scalp->roots == roots) return *scalp;
  }
  asset_cache.covers.push_back(std::make_unique<ScalpCover>(
      ScalpCover{freshId(), body.id, std::move(roots), rootCover(body.character, haircut.mesh)}));
  return *asset_cache.covers.back();
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

// Where the scene stands the figure.
Rigid standingPlace(const CharacterSpec& spec) {
  return Eigen::Translation3d(spec.position) * Eigen::AngleAxisd(spec.heading, Vec3::UnitY());
}

// The playback's pose where the scene stands the figure; of the joints in `needed` when it is given.
void placedPose(const Actor& actor, std::span<const unsigned char> needed, Pose& pose) {
  poseAt(actor.body->character.skeleton, actor.playedClip(), actor.playback, pose, needed);
  const Rigid place = standingPlace(actor.spec);
  for (std::size_t j = 0; j < pose.world.size(); ++j) {
    if (needed.empty() || needed[j]) pose.world[j] = place * pose.world[j];
  }
}

// s, between the poses that the reach is taken from.
constexpr double kReachInterval = 0.2;

// World, around the joints at all times of the clip, of a figure that does not go on. Empty for one that does.
Eigen::AlignedBox3d reachOf(const Actor& actor) {
  Eigen::AlignedBox3d box;
  if (actor.playback.loop.kind == LoopKind::kGoOn) return box;
  Actor playing;
  playing.spec = actor.spec;
  playing.body = actor.body;
  playing.clip = actor.clip;
  playing.playback = actor.playback;
  Pose pose;
  const double duration = actor.playedClip().duration();
  const int poses = static_cast<int>(std::min(duration / kReachInterval, 1000.0)) + 1;
  for (int i = 0; i <= poses; ++i) {
    playing.playback.time = i * duration / poses;
    placedPose(playing, {}, pose);
    for (const Rigid& joint : pose.world) box.extend(joint.translation());
  }
  return box;
}

Vec3 headCentre(const Character& character, const Rigid& scalp) {
  return scalp * character.scalp.center;
}

Rigid headAt(double time, const Actor& actor, Pose& pose) {
  Playback moment = actor.playback;
  moment.time = time;
  poseAt(actor.body->character.skeleton, actor.playedClip(), moment, pose);
  const Rigid place = standingPlace(actor.spec);
  for (Rigid& joint : pose.world) joint = place * joint;
  return scalpToWorld(actor.body->character, pose);
}

void carryHair(const Rigid& from, const Rigid& to, Actor& actor) {
  sim::carryAlong(from, to, actor.hair);
  if (actor.coarse.active) sim::carryAlong(from, to, actor.coarse.hair);
  wakeAll(actor);
}

// The figure has jumped from its clip's end to the start: the hair and the pose before the step are carried along, as
// if it had been there.
void carryOverCut(Actor& actor) {
  Pose start, end;
  const Rigid to = headAt(0, actor, start), from = headAt(actor.playedClip().duration(), actor, end);
  carryHair(from, to, actor);
  actor.jumped += headCentre(actor.body->character, to) - headCentre(actor.body->character, from);
  const Rigid jump = to * from.inverse();
  if (actor.playback.loop.kind == LoopKind::kNone) {
    actor.pose = std::move(start);
  } else {
    for (Rigid& joint : actor.pose.world) joint = jump * joint;
  }
}

void followScalp(const Actor& actor, const Haircut& haircut, std::vector<sim::Vec3>& roots) {
  const Rigid scalp = scalpToWorld(actor.body->character, actor.pose);
  const sim::HairMeshShape& shape = haircut.mesh.shape;
  roots.resize(shape.columnCount());
  for (int c = 0; c < shape.columnCount(); ++c) roots[c] = scalp * shape.positions[shape.column_first[c]];
}

// Pins vertices firmly to the head where they are at rest: those in buns and under attachments.
void holdAtRest(std::span<const int> vertices, Actor& actor) {
  const Character& character = actor.body->character;
  for (const int v : vertices) {
    const Vec3 at = character.head_frame * actor.haircut->mesh.shape.positions[static_cast<std::size_t>(v)];
    actor.pins.push_back({v, character.head_joint, at, PinSpec::kForever, 0, PinSpec::kForever, false});
  }
}

// The way that it faces, less its heading: see Actor::front.
double frontOf(const Actor& actor) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const Vec3 ahead = scalpToWorld(actor.body->character, actor.pose).linear() * Vec3::UnitZ();
  return kQuarter *
         std::round(std::remainder(std::atan2(ahead.x(), ahead.z()) - actor.spec.heading, 4 * kQuarter) / kQuarter);
}

}  // namespace

Actor makeActor(const CharacterSpec& spec, const PlaybackSpec& playback, AssetCache& asset_cache) {
  Actor actor;
  actor.spec = spec;
  LoadedBody& body = loadBody(spec, asset_cache);
  actor.body = &body;
  actor.haircut = &cutHair(spec, body, asset_cache);
  for (const Attachment* mesh : attach(spec, body, asset_cache)) actor.worn.push_back({mesh, freshId()});
  if (actor.haircut->look)
    takeUnset(*actor.haircut->look, spec.look_before.value_or(render::HairLook{}), actor.spec.look.hair);
  actor.spec.maps = withFields(*actor.haircut, spec);
  actor.spec.fields_of = spec.hair;
  actor.scalp = &coverScalp(body, *actor.haircut, asset_cache);
  actor.clip = findClip(spec, actor.body->character);
  actor.id = freshId();
  actor.playback.speed = playback.speed;
  actor.playback.loop = clipLoop(body.character.skeleton, actor.playedClip(), spec.loop);
  startPlayback(actor.playedClip(), spec.clip_offset, actor.playback);
  actor.context = std::make_unique<sim::StepContext>(actor.haircut->mesh, now);
  actor.reach = reachOf(actor);
  placeActor(actor, true);
  actor.front = frontOf(actor);
  repin(spec.pins, actor);
  const std::vector<int>& ring = actor.haircut->tied;
  const std::vector<Vec3> places =
      ringPlaces(actor.haircut->mesh.shape, body.character.scalp, actor.haircut->ties, ring);
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec3 at = body.character.head_frame * places[k];
    actor.pins.push_back({ring[k], body.character.head_joint, at, PinSpec::kForever, 0, PinSpec::kForever, false});
  }
  holdAtRest(actor.haircut->wound, actor);
  holdAtRest(actor.haircut->covered, actor);
  for (const WornAttachment& worn : actor.worn) markMoving(worn.mesh->part.joint, body);
  for (const ActorPin& pin : actor.pins) markMoving(pin.joint, body);
  return actor;
}

const HaircutPair* coarsePair(const Actor& actor, Resolution resolution, AssetCache& asset_cache) {
  const Resolution own = actor.spec.resolution;
  if (!actor.spec.hair.empty() || actor.haircut->edited || !actor.worn.empty() || own == resolution ||
      own == Resolution::kMinimal)
    return nullptr;
  for (const auto& pair : asset_cache.pairs) {
    if (pair->fine == actor.haircut && pair->resolution == resolution) return pair.get();
  }
  CharacterSpec spec = actor.spec;
  spec.resolution = resolution;
  auto pair = std::make_unique<HaircutPair>();
  pair->resolution = resolution;
  pair->fine = actor.haircut;
  pair->coarse = &cutHair(spec, loadBody(spec, asset_cache), asset_cache);
  pair->to_coarse = sim::makeShapeTransfer(pair->fine->mesh, pair->coarse->mesh);
  pair->to_fine = sim::makeShapeTransfer(pair->coarse->mesh, pair->fine->mesh);
  asset_cache.pairs.push_back(std::move(pair));
  return asset_cache.pairs.back().get();
}

void wearHaircut(const Haircut& haircut, Actor& actor, AssetCache& asset_cache) {
  actor.haircut = &haircut;
  actor.scalp = &coverScalp(*actor.body, haircut, asset_cache);
  actor.context = std::make_unique<sim::StepContext>(haircut.mesh, now);
  actor.context->refreshGradually(true);
  actor.coarse = {};
  actor.detail.coarse.reset();
  followScalp(actor, haircut, actor.roots);
  actor.error_meter = {};
  actor.sleep = {};
  ++actor.layout_revision;
  actor.shown_still = false;
}

void tidy(const std::vector<Actor>& actors, AssetCache& asset_cache) {
  const auto worn = [&](const auto& entry) {
    return std::any_of(actors.begin(), actors.end(), [&](const Actor& actor) {
      const HaircutPair* pair = actor.coarse.pair;
      const auto is = [&](const WornAttachment& one) { return static_cast<const void*>(one.mesh) == entry.get(); };
      return std::ranges::any_of(actor.worn, is) || static_cast<const void*>(actor.body) == entry.get() ||
             static_cast<const void*>(actor.haircut) == entry.get() ||
             static_cast<const void*>(actor.scalp) == entry.get() ||
             (pair &&
              (static_cast<const void*>(pair) == entry.get() || static_cast<const void*>(pair->coarse) == entry.get()));
    });
  };
  std::erase_if(asset_cache.pairs, [&](const auto& pair) { return !worn(pair); });
  std::erase_if(asset_cache.bodies, [&](const auto& body) { return !worn(body); });
  std::erase_if(asset_cache.haircuts, [&](const auto& haircut) { return !worn(haircut); });
  std::erase_if(asset_cache.attachments, [&](const auto& attachment) { return !worn(attachment); });
  std::erase_if(asset_cache.covers, [&](const auto& scalp) { return !worn(scalp); });
}

void wakeAll(Actor& actor) {
  actor.sleep.asleep = false;
}

void placeActor(Actor& actor, bool rest) {
  const bool stood = !actor.pose.world.empty();
  const Rigid before = stood ? scalpToWorld(actor.body->character, actor.pose) : Rigid::Identity();
  placedPose(actor, {}, actor.pose);
  const Rigid after = scalpToWorld(actor.body->character, actor.pose);
  if (stood && !rest) {
    carryHair(before, after, actor);
  } else {
    actor.hair = sim::restState(actor.haircut->mesh, after);
  }
  if (stood) actor.jumped += headCentre(actor.body->character, after) - headCentre(actor.body->character, before);
  actor.previous_pose = actor.pose;
  actor.shown_pose = actor.pose;  // requests may ask for it before the first frame
  actor.previous_positions = actor.hair.positions;
  poseEllipsoids(actor.body->character, actor.pose, actor.pose, 0, actor.ellipsoids);
  followScalp(actor, *actor.haircut, actor.roots);
  actor.posed_time = actor.playback.time;
  actor.pose_still = false;
  actor.span = 1;
  actor.ahead = 0;
  actor.coarse.active = false;
  actor.shown_still = false;
  wakeAll(actor);
}

void chooseLoop(LoopKind kind, Actor& actor) {
  actor.spec.loop = kind;
  actor.playback.loop = clipLoop(actor.body->character.skeleton, actor.playedClip(), kind);
  actor.playback.place = {};
  actor.reach = reachOf(actor);
  placeActor(actor, false);
}

void goOnWithClip(const std::string& name, Actor& actor) {
  CharacterSpec spec = actor.spec;
  spec.clip = name;
  const Character& character = actor.body->character;
  actor.clip = findClip(spec, character);
  spec.clip_offset = 0;
  actor.spec = std::move(spec);
  actor.playback.loop = clipLoop(character.skeleton, actor.playedClip(), actor.spec.loop);
  startPlayback(actor.playedClip(), 0, actor.playback);
  if (actor.playback.loop.kind == LoopKind::kGoOn) {
    Pose standing = actor.pose;
    const Rigid from_scene = standingPlace(actor.spec).inverse();
    for (Rigid& joint : standing.world) joint = from_scene * joint;
    actor.playback.place = placeToGoOn(character.skeleton, actor.playedClip(), standing);
  }
  actor.reach = reachOf(actor);
  placeActor(actor, false);
}

bool moveActor(double step, Actor& actor, bool skip_still_pose, bool skip_idle_bones) {
  const long rounds = advancePlayback(actor.playedClip(), step, actor.playback);
  if (rounds > 0 && actor.playback.loop.cuts()) carryOverCut(actor);
  const bool still = actor.playback.time == actor.posed_time;
  if (still && actor.pose_still && skip_still_pose) return false;
  std::swap(actor.previous_pose, actor.pose);
  const std::span<const unsigned char> all;
  placedPose(actor, skip_idle_bones ? std::span<const unsigned char>(actor.body->moving_joints) : all, actor.pose);
  followScalp(actor, *actor.haircut, actor.roots);
  poseEllipsoids(actor.body->character, actor.pose, actor.previous_pose, step, actor.ellipsoids);
  actor.pose_still = still;
  actor.posed_time = actor.playback.time;
  actor.shown_still = false;
  return true;
}

void enterCoarse(const HaircutPair& pair, Actor& actor) {
  CoarseHair& coarse = actor.coarse;
  const sim::HairMesh &fine_mesh = pair.fine->mesh, &coarse_mesh = pair.coarse->mesh;
  if (coarse.pair != &pair || !coarse.context) {
    coarse.pair = &pair;
    coarse.context = std::make_unique<sim::StepContext>(coarse_mesh, now);
    coarse.hair.positions.resize(static_cast<std::size_t>(coarse_mesh.vertexCount()));
    coarse.hair.velocities.resize(static_cast<std::size_t>(coarse_mesh.vertexCount()));
    coarse.remainder.resize(static_cast<std::size_t>(fine_mesh.vertexCount()));
  }
  const Rigid head = scalpToWorld(actor.body->character, actor.pose);
  sim::transferPositions(pair.to_coarse, fine_mesh, coarse_mesh, head, actor.hair.positions, coarse.hair.positions);
  sim::transferVectors(pair.to_coarse, actor.hair.velocities, coarse.hair.velocities);
  followScalp(actor, *pair.coarse, coarse.roots);
  for (int c = 0; c < coarse_mesh.columnCount(); ++c)
    coarse.hair.positions[coarse_mesh.shape.column_first[c]] = coarse.roots[c];
  coarse.hair.contacts.clear();
  coarse.hair.previous_dt = 0;
  coarse.hair.memory = {};
  sim::transferPositions(pair.to_fine, coarse_mesh, fine_mesh, head, coarse.hair.positions, coarse.remainder);
  for (std::size_t i = 0; i < coarse.remainder.size(); ++i)
    coarse.remainder[i] = head.linear().transpose() * (actor.hair.positions[i] - coarse.remainder[i]);
  coarse.active = true;
}

void leaveCoarse(Actor& actor) {
  // Positions and velocities have been kept up to date; what only the fine mesh knows starts anew.
  actor.hair.contacts.clear();
  actor.hair.previous_dt = 0;
  actor.hair.memory = {};
  actor.coarse.active = false;
}

namespace {

sim::StepReport simulateCoarse(const sim::SimParams& params, sim::StepInput input, double step, Actor& actor) {
  CoarseHair& coarse = actor.coarse;
  const sim::HairMesh &fine_mesh = coarse.pair->fine->mesh, &coarse_mesh = coarse.pair->coarse->mesh;
  followScalp(actor, *coarse.pair->coarse, coarse.roots);
  input.roots = coarse.roots;
  pinsOfCoarse(fine_mesh, coarse_mesh, scalpToWorld(actor.body->character, actor.pose), actor.pinned, coarse.pins);
  input.pins = coarse.pins;
  const sim::StepReport report = sim::advance(coarse_mesh, params, input, step, *coarse.context, coarse.hair);
  const Rigid head = scalpToWorld(actor.body->character, actor.pose);
  sim::transferPositions(coarse.pair->to_fine, coarse_mesh, fine_mesh, head, coarse.hair.positions,
                         actor.hair.positions);
  sim::transferVectors(coarse.pair->to_fine, coarse.hair.velocities, actor.hair.velocities);
  const double kept = std::exp(-step / kRemainderTime);
  for (std::size_t i = 0; i < coarse.remainder.size(); ++i) {
    coarse.remainder[i] *= kept;
    actor.hair.positions[i] += head.linear() * coarse.remainder[i];
  }
  for (int c = 0; c < fine_mesh.columnCount(); ++c) {
    const int root = fine_mesh.shape.column_first[c];
    actor.hair.velocities[root] = (actor.roots[c] - actor.previous_positions[root]) / step;
    actor.hair.positions[root] = actor.roots[c];
  }
  return report;
}

}  // namespace

sim::StepReport simulateActor(const sim::SimParams& params, double step, double time, Actor& actor) {
  std::copy(actor.hair.positions.begin(), actor.hair.positions.end(), actor.previous_positions.begin());
  actor.shown_still = false;
  const sim::StepInput input = stepInput(params, step, time, actor);
  if (actor.coarse.active) {
    actor.last_report = simulateCoarse(params, input, step, actor);
  } else {
    actor.last_report = sim::advance(actor.haircut->mesh, params, input, step, *actor.context, actor.hair);
  }
  return actor.last_report;
}

sim::StepReport stepActor(const sim::SimParams& params, double step, double time, Actor& actor) {
  moveActor(step, actor);
  return simulateActor(params, step, time, actor);
}

void settleActor(const sim::SimParams& params, double seconds, Actor& actor) {
  wakeAll(actor);
  actor.max_work = INFINITY;
  sim::SimParams thick = params;
  thick.air_drag = std::max(params.air_drag, kSettlingDrag);
  thick.wind_x = thick.wind_y = thick.wind_z = 0;
  const int steps = static_cast<int>(seconds / params.time_step);
  if (steps == 0) return;
  if (actor.coarse.active) {
    for (int i = 0; i < steps; ++i) simulateActor(thick, params.time_step, 0, actor);
    actor.previous_positions = actor.hair.positions;
    return;
  }
  const sim::StepInput input = stepInput(thick, params.time_step, 0, actor);
  for (int i = 0; i < steps; ++i)
    sim::advance(actor.haircut->mesh, thick, input, params.time_step, *actor.context, actor.hair);
  actor.previous_positions = actor.hair.positions;
}

void settleInMotion(const sim::SimParams& params, double seconds, Actor& actor) {
  constexpr double kStride = 0.5;  // s
  constexpr int kMaxStrides = 8;
  const Playback here = actor.playback;
  const auto goBack = [&](int strides) {
    actor.playback.time = here.time - strides * kStride;
    placeActor(actor, true);
  };
  int from = 0, least = std::numeric_limits<int>::max();
  for (int k = 0; seconds > 0 && k <= kMaxStrides && k * kStride <= here.time; ++k) {
    goBack(k);
    const int pushed = simulateActor(params, params.time_step, 0, actor).corrected;
    if (pushed < least) least = pushed, from = k;
  }
  goBack(from);
  settleActor(params, seconds, actor);
  actor.playback.paused = false;
  actor.playback.speed = 1;
  const auto steps = static_cast<int>(std::ceil(from * kStride / params.time_step));
  const double step = from * kStride / std::max(1, steps);
  for (int k = 0; k < steps; ++k) stepActor(params, step, k * step, actor);
  actor.playback = here;
  placeActor(actor, false);  // where its clock says, to the bit
}

void showActor(double fraction, const Vec3& origin, Actor& actor) {
  if (actor.shown_still && !actor.shown_positions.empty()) return;
  // Between the ends of the actor's own step, which may cover several of the clock's.
  const double within = (actor.span - 1 - actor.ahead + fraction) / actor.span;
  const Character& character = actor.body->character;
  blendPoses(character.skeleton, character.head_joint, actor.previous_pose, actor.pose, within, actor.shown_pose);
  if (blendPositions(actor.previous_positions, actor.hair.positions, within, origin, actor.shown_positions)) {
    ++actor.position_revision;
  }
  const bool moved = showAttachments(origin, actor);
  if (jointMatrices(actor.body->character.skeleton, actor.shown_pose, origin, actor.joint_matrices) || moved)
    ++actor.pose_revision;
  showSkin(actor.body->character, actor.body->unfit_parts, actor.shown_pose, origin, actor.shown_skin);
  actor.shown_still = actor.pose_still && (actor.sleep.asleep || actor.unseen);
}

}  // namespace app
