#include "app/scene/edit/hand_pins.h"

#include <algorithm>

#include "app/groom/edit/shape_brush.h"
#include "app/scene/demo.h"

namespace app {

namespace {

// World to the frame that a pin's place is in.
Rigid worldToPin(const PinSpec& pin, const ActorPin& found, const Actor& actor) {
  if (pin.to == "scalp") return scalpToWorld(actor.body->character, actor.pose).inverse(Eigen::Isometry);
  if (found.joint < 0) return Rigid::Identity();
  return actor.pose.world[static_cast<std::size_t>(found.joint)].inverse(Eigen::Isometry);
}

// To a tenth of a millimetre, as files have it.
Vec3 rounded(const Vec3& place) {
  return ((1e4 * place).array().round() / 1e4).matrix();
}

// The joint that stands across the parting from this one while the figure stands at rest; of one in the middle itself.
// What is no joint (scalp, scene) has none across.
std::string jointAcross(const std::string& name, const Character& character) {
  const std::vector<Joint>& joints = character.skeleton.joints;
  const auto named = std::ranges::find(joints, name, &Joint::name);
  if (named == joints.end()) return name;
  const Pose standing = restPose(character.skeleton);
  const Rigid from_world = scalpToWorld(character, standing).inverse(Eigen::Isometry);
  const auto placeOf = [&](std::size_t j) { return Vec3(from_world * standing.world[j].translation()); };
  auto nearest = static_cast<std::size_t>(named - joints.begin());
  const Vec3 across = mirrored(placeOf(nearest), character.scalp.center.x());
  double least = (placeOf(nearest) - across).norm();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double apart = (placeOf(j) - across).norm();
    if (apart < least - 1e-6) least = apart, nearest = j;
  }
  return joints[nearest].name;
}

PinSpec pinHere(int vertex, const PinChoice& choice, const Actor& actor) {
  PinSpec pin;
  pin.vertex = vertex;
  pin.to = choice.to, pin.stiffness = choice.stiffness, pin.from = choice.from, pin.until = choice.until;
  const std::vector<ActorPin> found = findPins({pin}, actor.haircut->mesh, actor.body->character, actor.pose);
  pin.at = rounded(worldToPin(pin, found[0], actor) * actor.hair.positions[static_cast<std::size_t>(vertex)]);
  return pin;
}

}  // namespace

std::vector<int> withLikesAcross(std::span<const int> vertices, const Actor& actor) {
  std::vector<int> both(vertices.begin(), vertices.end());
  for (const int v : vertices) {
    const int like = likeAcross(v, actor.body->character.scalp.center.x(), actor.haircut->mesh);
    if (std::ranges::find(both, like) == both.end()) both.push_back(like);
  }
  return both;
}

std::vector<int> pinnedVertices(const Actor& actor) {
  std::vector<int> vertices;
  for (std::size_t k = 0; k < actor.spec.pins.size(); ++k) vertices.push_back(actor.pins[k].vertex);
  return vertices;
}

std::vector<PinSpec> withoutPins(std::span<const int> vertices, const Actor& actor) {
  std::vector<PinSpec> pins;
  for (std::size_t k = 0; k < actor.spec.pins.size(); ++k) {
    if (std::ranges::find(vertices, actor.pins[k].vertex) == vertices.end()) pins.push_back(actor.spec.pins[k]);
  }
  return pins;
}

std::vector<PinSpec> withPins(std::span<const int> vertices, PinChoice choice, bool mirror, const Actor& actor) {
  const std::vector<int> all =
      mirror ? withLikesAcross(vertices, actor) : std::vector<int>(vertices.begin(), vertices.end());
  std::vector<PinSpec> pins = withoutPins(all, actor);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k == vertices.size()) choice.to = jointAcross(choice.to, actor.body->character);
    if (!actor.haircut->mesh.isRoot(all[k])) pins.push_back(pinHere(all[k], choice, actor));
  }
  return pins;
}

void applyPins(const std::vector<PinSpec>& pins, int index, Demo& demo) {
  Actor& actor = demo.actors[static_cast<std::size_t>(index)];
  repin(pins, actor);
  actor.shown_still = false;
  wakeAll(actor);
  const std::size_t count = pins.size();
  demo.message = count == 0 ? "nothing is pinned" : std::to_string(count) + (count == 1 ? " pin" : " pins");
  demo.message_is_fault = false;
}

void carryPins(std::span<const int> dragged, std::span<const Vec3> before, Actor& actor) {
  const Eigen::Matrix3d to_world = scalpToWorld(actor.body->character, actor.pose).linear();
  std::vector<PinSpec> pins = actor.spec.pins;
  bool moved = false;
  for (std::size_t k = 0; k < pins.size(); ++k) {
    const auto v = static_cast<std::size_t>(actor.pins[k].vertex);
    if (!pins[k].at || std::ranges::find(dragged, actor.pins[k].vertex) == dragged.end()) continue;
    const Vec3 way = to_world * (actor.haircut->mesh.shape.positions[v] - before[v]);
    *pins[k].at += worldToPin(pins[k], actor.pins[k], actor).linear() * way;
    moved = true;
  }
  if (moved) repin(std::move(pins), actor);
}

std::vector<PinSpec> pinsForAnotherMesh(const Actor& actor) {
  std::vector<PinSpec> pins = actor.spec.pins;
  for (std::size_t k = 0; k < pins.size(); ++k) {
    const auto v = static_cast<std::size_t>(actor.pins[k].vertex);
    pins[k].near = actor.haircut->mesh.shape.positions[v];
    pins[k].vertex = pins[k].column = pins[k].layer = -1;
  }
  return pins;
}

}  // namespace app
