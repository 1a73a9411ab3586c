// An actor: one character of the scene with its hair, as loaded and as it moves.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/figure/attachment.h"
#include "app/figure/body_sdf.h"
#include "app/figure/character.h"
#include "app/files/scene_file.h"
#include "app/groom/edit/shape_brush.h"
#include "app/groom/fit/look_fit.h"
#include "app/groom/inspect/certain_mends.h"
#include "app/motion/playback.h"
#include "app/scene/braid/braid_plan.h"
#include "app/scene/detail/step_error.h"
#include "app/scene/edit/cut_stroke.h"
#include "app/scene/edit/painted_fields.h"
#include "app/scene/pins.h"
#include "app/scene/sim_to_render.h"
#include "app/styles/style_tie.h"
#include "render/frame_input.h"
#include "render/strands/groom_offsets.h"
#include "sim/mesh/hair_mesh.h"
#include "sim/mesh/hair_state.h"
#include "sim/mesh/rest_shape.h"
#include "sim/mesh/shape_transfer.h"
#include "sim/sleep.h"
#include "sim/step.h"

namespace app {

// A character file, loaded once whatever the number of actors that play it.
struct LoadedBody {
  std::string key;
  std::uint64_t id = 0;
  Character character;
  BodyDistance distance;
  std::vector<PartDistance> unfit_parts;  // in place of the ellipsoids that do not fit
  bool has_parts = false;                 // they are made when signed distances are first collided with
  std::vector<PartDistance> parts;
  std::vector<unsigned char> moving_joints;  // per joint: whether skin, ellipsoids or scalp hang on it or below it
  // The parts while they are made beside the frames; the ellipsoids act until then. Last, so that whoever drops the
  // body waits for the thread, which reads the character, before that goes.
  std::future<std::vector<PartDistance>> parts_coming;
};

// A hair mesh, built once whatever the number of actors that wear it.
struct Haircut {
  std::string key;              // of what it was made of; its own once it is edited
  std::string key_with_fields;  // the same once an actor has the fields that its file brings; empty once it is edited
  std::uint64_t id = 0;
  std::string note;                     // what was found of a file that does not fit the head, or was converted
  std::optional<LookFit> look;          // of a groom's strands
  FieldFiles fields;                    // of the look, that the hair's file brings
  std::vector<MendedFinding> findings;  // of a groom, what the inspector says
  sim::HairMesh mesh;
  std::vector<HairTie> ties;   // where they are
  std::vector<int> tied;       // vertices in the rings of ties
  std::vector<HairTie> bands;  // the ties as they are seen: as narrow as what they hold
  BraidPlan braids;            // tails that are drawn as plaits or buns; empty: none
  std::vector<int> wound;      // vertices of buns, beyond their rings; ascending
  std::vector<int> covered;    // vertices under attachments, which hold them
  PaintedShares shares;
  PaintedLook look_shares;
  // Rest positions: before a painted length, none where hair is tied or covered; as brushes found them; and before
  // attachments cover them, none where none do.
  std::vector<Vec3> unpainted, painted, uncovered;
  // What brushes had made of it before ties and attachments, and the same places without brushes; none of another mesh.
  std::optional<sim::HairMeshShape> loose;
  std::vector<Vec3> grown;
  std::vector<render::HairFace> faces;
  std::vector<float> rest;  // positions of the rest shape, three floats a vertex
  // Of a groom's hair: from where its mesh is to where strands grow, and where that is at rest. Empty: they are one.
  render::GroomOffsets offsets;
  std::vector<float> rest_drawn;
  // Of hair that brushes have reshaped, which one actor alone wears.
  bool edited = false;
  bool remeshed = false;      // its structure is another than style or file, ties and attachments make it
  std::vector<float> frozen;  // per vertex: share of a brush's way that it does not go; empty: none
  std::optional<sim::RestShape> reshape;
  mutable std::optional<ShapeBrushes> brushes;  // scratch
  std::optional<CutStroke> cut;                 // the one that is being drawn
};

// Where a body is scalp among the roots of haircuts; see root_cover.h.
struct ScalpCover {
  std::uint64_t id = 0, body_id = 0;
  std::vector<sim::Vec3> roots;  // m, scalp frame: corners of the root faces, one after the other
  std::vector<float> cover;
};

// An attachment on one actor.
struct WornAttachment {
  const Attachment* mesh = nullptr;
  std::uint64_t id = 0;                                   // of what is drawn
  Eigen::Affine3d dragged = Eigen::Affine3d::Identity();  // joint frame: to where it is drawn while dragged
  render::Mat4 matrix{};                                  // joint to world, less the picture's origin
};

// Two resolutions of a style on one head, and the transfers between them.
struct HaircutPair {
  const Haircut* fine = nullptr;
  const Haircut* coarse = nullptr;
  Resolution resolution = Resolution::kLow;  // of the coarse one
  sim::ShapeTransfer to_coarse, to_fine;
};

// Owns what actors share. Addresses stay good while an entry is in use.
struct AssetCache {
  std::vector<std::unique_ptr<LoadedBody>> bodies;
  std::vector<std::unique_ptr<Haircut>> haircuts;
  std::vector<std::unique_ptr<HaircutPair>> pairs;
  std::vector<std::unique_ptr<ScalpCover>> covers;
  std::vector<std::unique_ptr<Attachment>> attachments;
};

// How much care the simulation takes of an actor.
struct SimDetail {
  int step_span = 1;                 // simulation steps that one step of the actor covers
  std::optional<Resolution> coarse;  // of its style, simulated in place of its own
  bool seen = true;                  // neither figure nor shadow can be in the picture otherwise
};

// The hair of an actor that is simulated at a lower resolution. Its own hair state is then filled from this one.
struct CoarseHair {
  const HaircutPair* pair = nullptr;
  bool active = false;
  sim::HairState hair;
  std::vector<sim::Vec3> roots;
  std::vector<sim::PinnedVertex> pins;
  std::unique_ptr<sim::StepContext> context;
  std::vector<sim::Vec3> remainder;  // m, head frame: what the coarse shape lacks, fading after the change-over
};

struct Actor {
  std::uint64_t id = 0;
  CharacterSpec spec;
  LoadedBody* body = nullptr;  // shared; changed only by what is made on demand
  const Haircut* haircut = nullptr;
  const ScalpCover* scalp = nullptr;  // of this body under this haircut
  int clip = 0;
  Playback playback;
  Eigen::AlignedBox3d reach;  // world, around the joints at all times of the clip; empty: the figure goes on
  double front = 0;           // rad about y, to the quarter turn: the way it faces as its clip begins, less its heading
  Vec3 jumped = Vec3::Zero();  // m, sum of the jumps of the head that no motion made

  // The last two simulated moments; the picture shows one in between.
  Pose pose, previous_pose;
  sim::HairState hair;
  std::vector<sim::Vec3> previous_positions;
  std::vector<sim::Ellipsoid> ellipsoids;
  std::vector<sim::BodySdf> parts;  // the same body as signed distances, where they are collided with
  std::vector<WornAttachment> worn;
  std::vector<sim::Ellipsoid> fitting_ellipsoids;  // of a body with parts that no ellipsoids fit: the others
  std::vector<sim::BodySdf> worn_distances;        // of what is worn, then of those parts
  std::vector<sim::Vec3> roots;
  std::vector<ActorPin> pins;
  std::vector<sim::PinnedVertex> pinned;  // those that are on, as the last step saw them
  std::unique_ptr<CutFinish> coming_cut;  // a cut that is being finished
  std::unique_ptr<sim::StepContext> context;
  sim::StepReport last_report;
  StepErrorMeter error_meter;

  // What may be left out, and for how long.
  SimDetail detail;
  CoarseHair coarse;
  sim::SleepState sleep;
  int span = 1, ahead = 0;     // steps that the last step covered; those of them that the clock has yet to take
  std::uint64_t steps = 0;     // of the clock; begins anywhere, so that long steps of a crowd spread over the frames
  double posed_time = -1;      // s, clip time of `pose`
  bool pose_still = false;     // pose and previous pose are one
  bool unseen = false;         // was not stepped last time
  bool shown_still = false;    // what is shown is what there is
  double usual_step = 0;       // s, a step's cost of late
  double max_work = INFINITY;  // units of the next step, see deadline.h

  // What the picture shows; positions and matrices relative to the picture's origin.
  Pose shown_pose;
  std::vector<float> shown_positions;
  ShownSkin shown_skin;
  std::vector<render::Mat4> joint_matrices;
  std::uint64_t layout_revision = 1, position_revision = 1, pose_revision = 1;

  const Clip& playedClip() const { return body->character.clips[clip]; }
};

// Loads what `spec` names and stands the actor at the start of its clip with its hair at rest. Throws InputError; the
// asset cache may then hold an entry more, and nothing else changed.
Actor makeActor(const CharacterSpec& spec, const PlaybackSpec& playback, AssetCache& asset_cache);

// The actor's style at low or minimal resolution with the transfers to it and back, made on first use; null
// for hair from a file and for hair that is already as coarse.
const HaircutPair* coarsePair(const Actor& actor, Resolution resolution, AssetCache& asset_cache);

// The actor wears another haircut from now on. Its hair must be of that mesh already; what moves goes on moving.
void wearHaircut(const Haircut& haircut, Actor& actor, AssetCache& asset_cache);

// Drops what no actor wears.
void tidy(const std::vector<Actor>& actors, AssetCache& asset_cache);

// Poses the actor at its playback's time without moving the clock; the hair is carried along rigidly (teleport of the
// second kind), or put to its rest shape when `rest` is set.
void placeActor(Actor& actor, bool rest);

// Another end of the present clip, from its first round on; another clip of the same file, from where the figure is.
// The hair is carried along rigidly. The second throws InputError, and then nothing has changed.
void chooseLoop(LoopKind kind, Actor& actor);
void goOnWithClip(const std::string& name, Actor& actor);

// One step of motion and hair: playback by `step` seconds of wall time, then the simulation. `time` is the step's end.
// moveActor and simulateActor are its two halves; moveActor returns whether anything moved.
bool moveActor(double step, Actor& actor, bool skip_still_pose = true, bool skip_idle_bones = true);
sim::StepReport simulateActor(const sim::SimParams& params, double step, double time, Actor& actor);
sim::StepReport stepActor(const sim::SimParams& params, double step, double time, Actor& actor);

// Goes over to the pair's coarse mesh, from the present shape and velocities of the actor's own; and back. What is
// shown does not jump: the difference of the two shapes is kept and fades.
void enterCoarse(const HaircutPair& pair, Actor& actor);
void leaveCoarse(Actor& actor);

// What sleeps is stepped again from the next step on.
void wakeAll(Actor& actor);

// Simulates `seconds` with the figure standing still and the air thick, so that the hair has come to rest on the body
// before the first frame.
void settleActor(const sim::SimParams& params, double seconds, Actor& actor);
// The same where a clip is being played: hair at rest lies in a shoulder that the head has turned to, and would be
// pushed out of it to any side. So it settles at that moment of the last 4 s at which the body pushes the fewest
// vertices, and is led from there to the present one at the clip's own speed.
void settleInMotion(const sim::SimParams& params, double seconds, Actor& actor);

// Positions, pose and matrices of the shown moment, between the last two states; positions and matrices relative to
// `origin` (m).
void showActor(double fraction, const Vec3& origin, Actor& actor);

}  // namespace app
