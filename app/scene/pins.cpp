#include "app/scene/pins.h"

#include <cmath>

#include "app/files/errors.h"
#include "app/scene/actor.h"
#include "sim/field_text.h"

namespace app {

namespace {

[[noreturn]] void refuse(const PinSpec& spec, const std::string& key, const std::string& fault,
                         const std::string& mend) {
  throw InputError(spec.file, spec.place + key, fault, mend);
}

std::string upTo(int count) {
  return "write a number from 0 to " + std::to_string(count - 1);
}

int nearestAtRest(const Vec3& place, const sim::HairMesh& mesh) {
  int nearest = -1;
  const auto distance = [&](int v) { return (mesh.shape.positions[v] - place).squaredNorm(); };
  for (int v = 0; v < mesh.vertexCount(); ++v) {
    if (!mesh.isRoot(v) && (nearest < 0 || distance(v) < distance(nearest))) nearest = v;
  }
  return nearest;
}

int findVertex(const PinSpec& spec, const sim::HairMesh& mesh) {
  if (spec.near) {
    constexpr double kFarthestNear = 1;  // m
    const int nearest = nearestAtRest(*spec.near, mesh);
    if ((mesh.shape.positions[nearest] - *spec.near).norm() > kFarthestNear)
      refuse(spec, "/near", "is over a metre from the hair at rest",
             "write metres from the head joint, x to the figure's left, y up, z to the front");
    return nearest;
  }
  int vertex = spec.vertex;
  if (spec.column >= 0) {
    if (spec.column >= mesh.columnCount()) {
      refuse(spec, "/column", "is " + std::to_string(spec.column) + ", and the hair has no such column",
             upTo(mesh.columnCount()));
    }
    const int length = mesh.shape.columnLength(spec.column);
    if (spec.layer >= length) {
      refuse(spec, "/layer", "is " + std::to_string(spec.layer) + ", and the column has no such layer",
             "write a number from 1 to " + std::to_string(length - 1) + ", or -1 for the tip");
    }
    vertex = mesh.shape.column_first[spec.column] + (spec.layer < 0 ? length - 1 : spec.layer);
  }
  if (vertex >= mesh.vertexCount()) {
    refuse(spec, "/vertex", "is " + std::to_string(vertex) + ", and the hair has no such vertex",
           upTo(mesh.vertexCount()));
  }
  if (mesh.isRoot(vertex)) {
    refuse(spec, "", "pins a root, which the scalp carries", "pin a vertex of a layer from 1 on");
  }
  return vertex;
}

int findJoint(const PinSpec& spec, const Skeleton& skeleton) {
  std::vector<std::string_view> names{"scalp", "scene"};
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.joints[j].name == spec.to) return static_cast<int>(j);
    names.push_back(skeleton.joints[j].name);
  }
  refuse(spec, "/to", "is '" + spec.to + "', and the figure has no such joint", sim::nameHint(spec.to, names));
}

}  // namespace

std::vector<ActorPin> findPins(const std::vector<PinSpec>& specs, const sim::HairMesh& mesh, const Character& character,
                               const Pose& pose) {
  std::vector<ActorPin> pins;
  for (const PinSpec& spec : specs) {
    ActorPin pin{findVertex(spec, mesh), -1, {}, spec.stiffness, spec.from, spec.until};
    const Vec3& rest = mesh.shape.positions[pin.vertex];  // scalp frame
    if (spec.to == "scalp") {
      pin.joint = character.head_joint;
      pin.at = character.head_frame * spec.at.value_or(rest);
    } else if (spec.to == "scene") {
      pin.at = spec.at.value_or(scalpToWorld(character, pose) * rest);
    } else {
      pin.joint = findJoint(spec, character.skeleton);
      const Pose standing = restPose(character.skeleton);
      pin.at = spec.at.value_or(standing.world[pin.joint].inverse() * (scalpToWorld(character, standing) * rest));
    }
    pins.push_back(pin);
  }
  return pins;
}

void markMoving(int joint, LoadedBody& body) {
  const std::vector<Joint>& joints = body.character.skeleton.joints;
  for (; joint >= 0; joint = joints[static_cast<std::size_t>(joint)].parent)
    body.moving_joints[static_cast<std::size_t>(joint)] = 1;
}

void repin(std::vector<PinSpec> specs, Actor& actor) {
  const std::vector<ActorPin> found = findPins(specs, actor.haircut->mesh, actor.body->character, actor.pose);
  for (std::size_t k = 0; k < specs.size(); ++k) {
    if (specs[k].near) specs[k].vertex = found[k].vertex, specs[k].near.reset();
    if (specs[k].to == "scene") specs[k].at = found[k].at;
  }
  std::erase_if(actor.pins, [](const ActorPin& pin) { return pin.of_spec; });
  actor.pins.insert(actor.pins.begin(), found.begin(), found.end());
  actor.spec.pins = std::move(specs);
  for (const ActorPin& pin : found) markMoving(pin.joint, *actor.body);
}

std::string idlePinNote(const Actor& actor) {
  const std::size_t count = actor.spec.pins.size();
  for (std::size_t second = 1; second < count; ++second) {
    const ActorPin& late = actor.pins[second];
    for (std::size_t first = 0; first < second; ++first) {
      const ActorPin& pin = actor.pins[first];
      const bool together = pin.from < late.until && late.from < pin.until;
      const bool firm = !std::isfinite(pin.stiffness) || !std::isfinite(late.stiffness);
      if (pin.vertex != late.vertex || !together || !firm) continue;
      return "pins " + std::to_string(first) + " and " + std::to_string(second) + " hold vertex " +
             std::to_string(pin.vertex) + " at the same time, and only the first firm one counts";
    }
  }
  return "";
}

void followRestPins(Actor& actor) {
  const auto resting = [](const PinSpec& spec) { return !spec.at; };
  if (std::ranges::any_of(actor.spec.pins, resting)) repin(actor.spec.pins, actor);
}

void posePins(const std::vector<ActorPin>& pins, const Pose& pose, const Pose& previous, double time, double dt,
              std::vector<sim::PinnedVertex>& posed) {
  posed.clear();
  for (const ActorPin& pin : pins) {
    if (time < pin.from || time >= pin.until) continue;
    sim::PinnedVertex one{pin.vertex, pin.at, Vec3::Zero(), pin.stiffness};
    if (pin.joint >= 0) {
      one.target = pose.world[pin.joint] * pin.at;
      if (dt > 0) one.velocity = (one.target - previous.world[pin.joint] * pin.at) / dt;
    }
    posed.push_back(one);
  }
}

void pinsOfCoarse(const sim::HairMesh& fine, const sim::HairMesh& coarse, const Rigid& head,
                  const std::vector<sim::PinnedVertex>& whole, std::vector<sim::PinnedVertex>& pins) {
  pins.clear();
  for (const sim::PinnedVertex& pin : whole) {
    const Vec3& rest = fine.shape.positions[pin.vertex];
    const int nearest = nearestAtRest(rest, coarse);
    pins.push_back(pin);
    pins.back().vertex = nearest;
    pins.back().target += head.linear() * (coarse.shape.positions[nearest] - rest);
  }
}

}  // namespace app
