// An actor: one character of the scene with its hair, as loaded and as it moves.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/character.h"
#include "app/motion.h"
#include "app/part_distances.h"
#include "app/scene_file.h"
#include "app/step_error.h"
#include "render/frame_input.h"
#include "sim/hair_mesh.h"
#include "sim/hair_state.h"
#include "sim/step.h"

namespace app {

// A character file, loaded once whatever the number of actors that play it.
struct LoadedBody {
  std::string key;
  std::uint64_t id = 0;
  Character character;
  sim::BodyDistance distance;
  bool has_parts = false;           // they are made when signed distances are first collided with
  std::vector<PartDistance> parts;
};

// A hair mesh, built once whatever the number of actors that wear it.
struct Haircut {
  std::string key;
  sim::HairMesh mesh;
  std::vector<render::HairFace> faces;
};

// Owns what actors share. Addresses stay good while an entry is in use.
struct Wardrobe {
  std::vector<std::unique_ptr<LoadedBody>> bodies;
  std::vector<std::unique_ptr<Haircut>> haircuts;
};

struct Actor {
  std::uint64_t id = 0;
  CharacterSpec spec;
  LoadedBody* body = nullptr;  // shared; changed only by what is made on demand
  const Haircut* haircut = nullptr;
  int clip = 0;
  Playback playback;

  // The last two simulated moments; the picture shows one in between.
  Pose pose, previous_pose;
  sim::HairState hair;
  std::vector<sim::Vec3> previous_positions;
  std::vector<sim::Ellipsoid> ellipsoids;
  std::vector<sim::DistancePart> parts;  // the same body as signed distances, where they are collided with
  std::vector<sim::Vec3> roots;
  std::unique_ptr<sim::StepContext> context;
  sim::StepReport last_report;
  StepErrorMeter error_meter;

  // What the picture shows.
  Pose shown_pose;
  std::vector<float> shown_positions;
  std::vector<render::Mat4> joint_matrices;
  std::uint64_t layout_revision = 1, position_revision = 1, pose_revision = 1;

  const Clip& playedClip() const { return body->character.clips[clip]; }
};

// Loads what `spec` names and stands the actor at the start of its clip with its hair at rest. Throws InputError; the
// wardrobe may then hold an entry more, and nothing else changed.
Actor makeActor(const CharacterSpec& spec, const PlaybackSpec& playback, Wardrobe& wardrobe);

// Drops what no actor wears.
void tidy(const std::vector<Actor>& actors, Wardrobe& wardrobe);

// Takes over the motion of `from` (time in the clip), as when only the hair was changed.
void keepMotion(const Actor& from, Actor& actor);

// Poses the actor at its playback's time without moving the clock; the hair is carried along rigidly (teleport of the
// second kind), or put to its rest shape when `rest` is set.
void placeActor(Actor& actor, bool rest);

// One step of motion and hair: playback by `step` seconds of wall time, then the simulation. `time` is the step's end.
// moveActor and simulateActor are its two halves.
void moveActor(double step, Actor& actor);
sim::StepReport simulateActor(const sim::SimParams& params, double step, double time, Actor& actor);
sim::StepReport stepActor(const sim::SimParams& params, double step, double time, Actor& actor);

// Simulates `seconds` with the figure standing still and the air thick, so that the hair has come to rest on the body
// before the first frame.
void settleActor(const sim::SimParams& params, double seconds, Actor& actor);

// Positions, pose and matrices of the shown moment, between the last two states.
void showActor(double fraction, Actor& actor);

}  // namespace app
