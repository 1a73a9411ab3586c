#include "app/scene/pins.h"

#include "app/files/errors.h"
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

int findVertex(const PinSpec& spec, const sim::HairMesh& mesh) {
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
    int nearest = -1;
    const auto distance = [&](int v) { return (coarse.shape.positions[v] - rest).squaredNorm(); };
    for (int v = 0; v < coarse.vertexCount(); ++v) {
      if (!coarse.isRoot(v) && (nearest < 0 || distance(v) < distance(nearest))) nearest = v;
    }
    pins.push_back(pin);
    pins.back().vertex = nearest;
    pins.back().target += head.linear() * (coarse.shape.positions[nearest] - rest);
  }
}

}  // namespace app
