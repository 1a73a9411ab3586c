#include "app/scene/edit/hand_pins.h"

#include <algorithm>

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

}  // namespace

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

std::vector<PinSpec> withPins(std::span<const int> vertices, const PinChoice& choice, const Actor& actor) {
  std::vector<PinSpec> pins = withoutPins(vertices, actor);
  for (const int v : vertices) {
    if (actor.haircut->mesh.isRoot(v)) continue;
    PinSpec pin;
    pin.vertex = v;
    pin.to = choice.to, pin.stiffness = choice.stiffness, pin.from = choice.from, pin.until = choice.until;
    const std::vector<ActorPin> found = findPins({pin}, actor.haircut->mesh, actor.body->character, actor.pose);
    pin.at = rounded(worldToPin(pin, found[0], actor) * actor.hair.positions[static_cast<std::size_t>(v)]);
    pins.push_back(std::move(pin));
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
