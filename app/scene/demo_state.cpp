#include "app/scene/demo_state.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <tuple>
#include <utility>

#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "app/scene/sim_to_render.h"
#include "sim/field_text.h"
#include "sim/forces/rest_balance.h"
#include "sim/mesh/field_bytes.h"
#include "sim/mesh/state_bytes.h"

namespace app {

namespace {

constexpr std::string_view kStateTitle = "hairmesh-state ";
constexpr const char* kSaveAnew = "save it anew with --save-state";

// What follows the line of title and version.
struct Head {
  std::uint64_t size = 0, checksum = 0;  // of the bytes that follow
  HAIRMESH_FIELDS(size, checksum)
};

// The members of a type that are saved as they are. All are named here, so that a new one does not compile until it is
// decided whether it is saved.
template <class P>
auto savedOf(P& playback) requires std::same_as<std::remove_const_t<P>, Playback> {
  auto& [time, speed, paused, loop, place] = playback;
  auto& [x, z, turn] = place;
  return std::tie(time, paused, x, z, turn);
}

template <class A>
auto savedOf(A& actor) requires std::same_as<std::remove_const_t<A>, Actor> {
  auto& [id, spec, body, haircut, scalp, clip, playback, reach, front, jumped, pose, previous_pose, hair,
         previous_positions, ellipsoids, parts, worn, fitting_ellipsoids, worn_distances, roots, pins, pinned,
         coming_cut, context, last_report, error_meter, detail, coarse, sleep, span, ahead, steps, posed_time,
         pose_still, unseen, shown_still, usual_step, max_work, shown_pose, shown_positions, shown_skin, joint_matrices,
         layout_revision, position_revision, pose_revision] = actor;
  auto& [step_span, coarse_mesh, seen] = detail;
  return std::tuple_cat(savedOf(playback),
                        std::tie(jumped, pose.world, previous_pose.world, previous_positions, ellipsoids, roots, pinned,
                                 error_meter, step_span, seen, sleep, span, ahead, steps, posed_time, pose_still,
                                 unseen, shown_still, shown_pose.world, shown_positions));
}

template <class D>
auto savedOf(D& demo) requires std::same_as<std::remove_const_t<D>, Demo> {
  auto& [scene, asset_cache, actors, selected, camera, aspect, picture_height, place, origin, shown_fraction, debug,
         clock, governor, draw_governor, deadline, running, frames, shown_time, paused, single_steps, edits, timeline,
         comparison, bookmarks, turntable, loading, requests, message, message_is_fault, refused, file_ends, capture,
         stats, history, history_next, debug_geometry, hair_inputs, drawn_hair, bands, body_inputs] = demo;
  auto& [ahead, lost, steps, time, step] = clock;
  return std::tie(camera.anchor, camera.jumped, aspect, picture_height, origin, shown_fraction, ahead, lost, steps,
                  time, step, frames, shown_time, paused);
}

template <class C>
auto viewOf(C& camera) {
  auto& [anchor, target, jumped, yaw, pitch, distance, fov, follow] = camera;
  return std::tie(target, yaw, pitch, distance);
}

// What a character must be for a state to be its.
std::string identity(const Actor& actor) {
  const CharacterSpec& spec = actor.spec;
  const auto name = [](const std::string& file) { return std::filesystem::path(file).filename().string(); };
  std::string text =
      name(spec.motion) + ", clip '" + actor.playedClip().name + "', " +
      (spec.hair.empty() ? std::string(styleName(spec.style)) + " " + std::string(resolutionName(spec.resolution))
                         : name(spec.hair));
  if (!spec.parts.empty()) text += ", parts " + name(spec.parts);
  if (!spec.ties.empty()) text += ", tied";
  if (actor.haircut->remeshed) text += ", a mesh of its own";
  for (const AttachmentSpec& one : spec.attachments) text += ", wears " + name(one.file);
  if (spec.position != Vec3::Zero() || spec.heading != 0) {
    text += ", at";
    for (const double value : {spec.position.x(), spec.position.y(), spec.position.z(), spec.heading})
      text.append(1, ' ').append(sim::numberText(value));
  }
  return text;
}

int numberOf(const std::optional<Resolution>& resolution) {
  return resolution ? static_cast<int>(*resolution) : -1;
}

// A character's part of a file as it is read: members of `actor` that are saved as they are, and what needs the meshes.
struct SavedActor {
  Actor actor;
  int chosen_mesh = -1, coarse_mesh = -1;  // resolutions; -1: none
  const HaircutPair* pair = nullptr;       // of coarse_mesh
};

void writeActor(const Actor& actor, sim::Bytes& out) {
  const std::string text = identity(actor);
  sim::writeBytes(std::vector<char>(text.begin(), text.end()), out);
  sim::writeBytes(savedOf(actor), out);
  sim::writeBytes(sim::saveState(actor.haircut->mesh, actor.hair), out);
  sim::writeBytes(numberOf(actor.detail.coarse), out);
  const CoarseHair& coarse = actor.coarse;
  sim::writeBytes(coarse.active ? static_cast<int>(coarse.pair->resolution) : -1, out);
  if (coarse.active) {
    sim::writeBytes(sim::saveState(coarse.pair->coarse->mesh, coarse.hair), out);
    sim::writeBytes(coarse.remainder, out);
  }
}

// Reads what belongs to one character of the scene at hand; throws what is wrong with it.
class ActorReader {
 public:
  ActorReader(const std::string& file, std::size_t number, sim::ByteReader& from)
      : file_(file), place_("character " + std::to_string(number + 1)), from_(from) {}

  SavedActor read(const Actor& shown, AssetCache& asset_cache) {
    checkIdentity(shown);
    SavedActor saved;
    auto fields = savedOf(saved.actor);
    sim::readBytes(from_, fields);
    readHair(shown.haircut->mesh, saved.actor.hair);
    saved.chosen_mesh = readMesh();
    saved.coarse_mesh = readMesh();
    if (saved.coarse_mesh >= 0) readCoarse(shown, asset_cache, saved);
    if (!from_.complete || !fits(shown, saved.actor)) fail("does not fit the scene's", kSaveAnew);
    return saved;
  }

 private:
  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const {
    throw InputError(file_, place_, fault, mend);
  }

  void checkIdentity(const Actor& shown) {
    std::vector<char> text;
    sim::readBytes(from_, text);
    const std::string saved(text.begin(), text.end());
    if (saved != identity(shown))
      fail("is " + saved + " where the scene has " + identity(shown), "open the scene that it was saved from");
  }

  void readHair(const sim::HairMesh& mesh, sim::HairState& hair) {
    sim::Bytes bytes;
    sim::readBytes(from_, bytes);
    if (const std::string fault = sim::loadState(mesh, bytes, hair); !fault.empty()) fail("its hair " + fault, "");
  }

  int readMesh() {
    int number = -1;
    sim::readBytes(from_, number);
    if (number < -1 || number > static_cast<int>(Resolution::kMinimal)) fail("has no such mesh", kSaveAnew);
    return number;
  }

  void readCoarse(const Actor& shown, AssetCache& asset_cache, SavedActor& saved) {
    saved.pair = coarsePair(shown, static_cast<Resolution>(saved.coarse_mesh), asset_cache);
    if (!saved.pair) fail("was simulated with a coarser mesh that it does not have", kSaveAnew);
    CoarseHair& coarse = saved.actor.coarse;
    readHair(saved.pair->coarse->mesh, coarse.hair);
    sim::readBytes(from_, coarse.remainder);
    if (coarse.remainder.size() != shown.hair.positions.size()) fail("does not fit the scene's", kSaveAnew);
  }

  // Whether sizes and indices are those of the scene's character: bytes may have been made by hand.
  static bool fits(const Actor& shown, const Actor& saved) {
    const std::size_t vertices = shown.hair.positions.size(), joints = shown.pose.world.size();
    const bool sized = saved.pose.world.size() == joints && saved.previous_pose.world.size() == joints &&
                       saved.shown_pose.world.size() == joints && saved.previous_positions.size() == vertices &&
                       saved.roots.size() == shown.roots.size() && saved.ellipsoids.size() == shown.ellipsoids.size() &&
                       (saved.shown_positions.empty() || saved.shown_positions.size() == 3 * vertices);
    const bool pinned = std::ranges::all_of(saved.pinned, [&](const sim::PinnedVertex& pin) {
      return pin.vertex >= 0 && static_cast<std::size_t>(pin.vertex) < vertices;
    });
    return sized && pinned && saved.span >= 1 && saved.ahead >= 0 && saved.ahead < saved.span &&
           saved.detail.step_span >= 1 && std::isfinite(saved.playback.time);
  }

  const std::string& file_;
  std::string place_;
  sim::ByteReader& from_;
};

void install(SavedActor saved, const Vec3& origin, Actor& actor) {
  savedOf(actor) = savedOf(saved.actor);
  actor.hair = std::move(saved.actor.hair);
  const auto contextOf = [](const sim::HairMesh& mesh) { return std::make_unique<sim::StepContext>(mesh, now); };
  std::vector<sim::V3<double>> sag = actor.context->material().sag();
  actor.context = contextOf(actor.haircut->mesh);
  actor.context->refreshGradually(true);
  // Of a mesh that has taken no step yet; any other has its balance made anew, to the bit.
  if (actor.haircut->remeshed && !actor.hair.memory.material.known) actor.context->material().startFrom(std::move(sag));
  actor.detail.coarse.reset();
  if (saved.chosen_mesh >= 0) actor.detail.coarse = static_cast<Resolution>(saved.chosen_mesh);
  actor.coarse = std::move(saved.actor.coarse);
  if (saved.pair) {
    actor.coarse.pair = saved.pair;
    actor.coarse.active = true;
    actor.coarse.context = contextOf(saved.pair->coarse->mesh);
  }
  jointMatrices(actor.body->character.skeleton, actor.shown_pose, origin, actor.joint_matrices);
  showSkin(actor.body->character, actor.body->unfit_parts, actor.shown_pose, origin, actor.shown_skin);
  ++actor.position_revision;
  ++actor.pose_revision;
}

// Takes title, version, size and checksum off the bytes of a file, or throws what is wrong with them.
std::span<const std::byte> bodyOf(const std::string& text, const std::string& file) {
  const std::size_t end = text.find('\n');
  if (!text.starts_with(kStateTitle) || end == std::string::npos)
    throw InputError(file, "", "is no saved state", "give a file that --save-state wrote");
  const std::string version = text.substr(kStateTitle.size(), end - kStateTitle.size());
  if (version != std::to_string(kDemoStateVersion))
    throw InputError(file, "",
                     "is a state of version " + version.substr(0, 20) + ", not " + std::to_string(kDemoStateVersion),
                     "save it anew with this program");
  sim::ByteReader from{std::as_bytes(std::span(text)).subspan(end + 1)};
  Head head;
  sim::readBytes(from, head);
  if (!from.complete || head.size != from.left.size())
    throw InputError(file, "",
                     "has " + std::to_string(text.size()) + " bytes where " +
                         std::to_string(head.size + (text.size() - from.left.size())) + " were saved",
                     kSaveAnew);
  if (sim::fingerprint(from.left) != head.checksum)
    throw InputError(file, "", "has been changed since it was saved", kSaveAnew);
  return from.left;
}

}  // namespace

std::string demoIdentity(const Demo& demo) {
  std::string text;
  for (const Actor& actor : demo.actors) text += (text.empty() ? "" : "; ") + identity(actor);
  return text;
}

std::string demoStateBytes(const Demo& demo) {
  sim::Bytes body, head;
  sim::writeBytes(std::uint64_t{demo.actors.size()}, body);
  for (const Actor& actor : demo.actors) writeActor(actor, body);
  sim::writeBytes(savedOf(demo), body);
  sim::writeBytes(viewOf(demo.camera), body);
  sim::writeBytes(demo.governor, body);
  sim::writeBytes(demo.deadline, body);
  sim::writeBytes(Head{body.size(), sim::fingerprint(body)}, head);
  std::string text = std::string(kStateTitle) + std::to_string(kDemoStateVersion) + "\n";
  for (const sim::Bytes& bytes : {head, body}) text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text;
}

void loadDemoState(const std::string& file, bool keep_view, Demo& demo) {
  if (isSimCache(file)) return SimCache(file, demo).resume(std::numeric_limits<long>::max(), keep_view, demo);
  restoreDemoState(readText(file), file, keep_view, demo);
}

void restoreDemoState(const std::string& text, const std::string& file, bool keep_view, Demo& demo) {
  sim::ByteReader from{bodyOf(text, file)};
  std::uint64_t count = 0;
  sim::readBytes(from, count);
  if (count != demo.actors.size())
    throw InputError(
        file, "",
        "has " + std::to_string(count) + " characters where the scene has " + std::to_string(demo.actors.size()),
        "open the scene that it was saved from");
  std::vector<SavedActor> actors;
  for (std::size_t i = 0; i < demo.actors.size(); ++i)
    actors.push_back(ActorReader(file, i, from).read(demo.actors[i], demo.asset_cache));
  Demo saved;
  auto fields = savedOf(saved);
  sim::readBytes(from, fields);
  auto view = viewOf(saved.camera);
  sim::readBytes(from, view);
  sim::readBytes(from, saved.governor);
  sim::readBytes(from, saved.deadline);
  const Governor& governor = saved.governor;
  const auto known = [](int rung) { return rung >= 0 && rung < static_cast<int>(ladder().size()); };
  if (!from.complete || !from.left.empty() || saved.frames < 0 || !known(governor.rung) || !known(governor.left_rung) ||
      !std::isfinite(saved.clock.ahead) || !std::isfinite(saved.clock.time))
    throw InputError(file, "", "does not fit the scene", kSaveAnew);

  noteMoment(demo.edits);
  savedOf(demo) = fields;
  if (!keep_view) viewOf(demo.camera) = view;
  // Another budget begins to learn anew.
  if (governor.budget == demo.governor.budget) {
    const bool counted = demo.governor.counted;
    demo.governor = governor;
    demo.governor.counted = counted;
  }
  if (saved.deadline.seconds == demo.deadline.seconds) {
    const bool counted = demo.deadline.counted;
    demo.deadline = saved.deadline;
    demo.deadline.counted = counted;
  }
  for (std::size_t i = 0; i < actors.size(); ++i) install(std::move(actors[i]), demo.origin, demo.actors[i]);
}

}  // namespace app
