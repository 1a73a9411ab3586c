#include "app/scene/view/preset_picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "app/files/presets.h"
#include "app/scene/attachments.h"
#include "app/scene/sim_to_render.h"
#include "app/scene/view/figure_input.h"

namespace app {

namespace {

constexpr double kPictureYaw = 0.5, kPicturePitch = 0.06;               // rad
constexpr double kPictureFov = 0.35;                                    // rad
constexpr double kPictureTop = 0.7, kPictureLow = 0.75, kLowest = 1.4;  // head heights about the middle of the cranium
constexpr int kPictureShadow = 256;                                     // pixels

template <class Owner, class Field>
void addRows(std::span<const Field> table, const Owner& owner, std::vector<double>& rows) {
  for (const Field& row : table) {
    if constexpr (std::same_as<Field, sim::ParamField>) {
      rows.push_back(row.get(owner));
    } else {
      const LookValue value = row.get(owner);
      rows.insert(rows.end(), value.begin(), value.end());
    }
  }
}

// The rest pose, turned to face +z.
Pose facingFront(const Character& character) {
  Pose pose = restPose(character.skeleton);
  const Rigid head = scalpToWorld(character, pose);
  const Vec3 forward = head.linear() * Vec3::UnitZ(), about = head.translation();
  const double yaw = std::hypot(forward.x(), forward.z()) > 1e-6 ? std::atan2(forward.x(), forward.z()) : 0;
  const Rigid turn =
      Eigen::Translation3d(about) * Eigen::AngleAxisd(-yaw, Vec3::UnitY()) * Eigen::Translation3d(-about);
  for (Rigid& joint : pose.world) joint = turn * joint;
  return pose;
}

// The head, and of the hair as much as hangs within two head heights.
render::CameraInput headCamera(const Character& character, const PresetScene& preset) {
  const double head = character.scalp.head_height;
  const Vec3 middle = scalpToWorld(character, preset.pose) * character.scalp.center;
  double lowest = middle.y();
  for (std::size_t v = 1; v < preset.positions.size(); v += 3)
    lowest = std::min(lowest, static_cast<double>(preset.positions[v]));
  const double low = -std::clamp((middle.y() - lowest) / head, kPictureLow, kLowest) * head, top = kPictureTop * head;
  Camera camera;
  camera.anchor = middle;
  camera.target = {0, 0.5 * (top + low), 0};
  camera.yaw = kPictureYaw, camera.pitch = kPicturePitch;
  camera.fov = kPictureFov;
  camera.distance = 0.5 * (top - low) / std::tan(0.5 * kPictureFov);
  return cameraInput(camera, {}, Vec3::Zero());
}

}  // namespace

PictureSubject pictureSubject(const Demo& demo) {
  const Actor& actor = selectedActor(demo);
  const std::vector<float>& rest = actor.haircut->rest;
  PictureSubject subject{actor.haircut->id, actor.body->id, 0, {}};
  subject.shape =
      std::hash<std::string_view>{}({reinterpret_cast<const char*>(rest.data()), rest.size() * sizeof(float)});
  addRows(sim::paramFields(), demo.scene.sim, subject.settings);
  addRows(hairFields(), actor.spec.look, subject.settings);
  addRows(sceneFields(), demo.scene.look, subject.settings);
  for (std::size_t k = 0; k < actor.spec.attachments.size(); ++k) {
    for (const float share : wornColor(actor, k)) subject.settings.push_back(static_cast<double>(share));
  }
  return subject;
}

PresetScene presetScene(const std::string& file, const Demo& demo) {
  const Actor& actor = selectedActor(demo);
  PresetScene preset;
  preset.sim = demo.scene.sim, preset.look = actor.spec.look, preset.scene = demo.scene.look;
  preset.pose = facingFront(actor.body->character);
  CharacterLook* look = &preset.look;
  loadPreset(file, {&preset.sim, &preset.scene, std::span(&look, 1)});
  preset.moves = presetSections(file).sim;
  return preset;
}

std::optional<Swing> swingOf(const PresetScene& preset, const Demo& demo) {
  const Actor& actor = selectedActor(demo);
  if (!preset.moves || !actor.pins.empty()) return {};
  const Character& character = actor.body->character;
  Swing swing{actor.haircut->mesh, preset.sim, scalpToWorld(character, preset.pose), {}};
  poseEllipsoids(character, preset.pose, preset.pose, 0, swing.body);
  return swing;
}

render::FrameInput presetFrame(const Demo& demo, const std::vector<Vec3>& positions, int width, int height,
                               std::uint64_t revision, PresetScene& preset) {
  const Actor& actor = selectedActor(demo);
  const Character& character = actor.body->character;
  const std::vector<Vec3> hair =
      positions.empty() ? sim::restState(actor.haircut->mesh, scalpToWorld(character, preset.pose)).positions
                        : positions;
  blendPositions(hair, hair, 1, Vec3::Zero(), preset.positions);
  jointMatrices(character.skeleton, preset.pose, Vec3::Zero(), preset.joints);
  showSkin(character, actor.body->unfit_parts, preset.pose, Vec3::Zero(), preset.skin);
  const bool strands = preset.scene.view.show_strands;
  preset.hairs = {hairInput(actor, preset.look, preset.positions, preset.drawn)};
  preset.hairs[0].position_revision = revision;
  if (preset.look.lift_strands) {
    preset.hairs[0].skin = preset.skin.ellipsoids;
    preset.hairs[0].skin_grids = preset.skin.grids;
  }
  preset.bodies = {bodyInput(actor, preset.look, strands)};
  preset.bodies[0].joint_matrices = preset.joints;
  preset.worn.clear();
  for (const WornAttachment& worn : actor.worn) {
    const Eigen::Matrix4f m = preset.pose.world[static_cast<std::size_t>(worn.mesh->part.joint)].matrix().cast<float>();
    std::copy(m.data(), m.data() + 16, preset.worn.emplace_back().begin());
  }
  for (std::size_t k = 0; k < actor.worn.size(); ++k) {
    preset.bodies.push_back(attachmentInput(actor, k, strands));
    preset.bodies.back().joint_matrices = {&preset.worn[k], 1};
  }
  if (strands) addBands(actor, preset.positions, preset.bands, preset.bodies);
  for (render::BodyInput& body : preset.bodies) body.pose_revision = revision;
  render::FrameInput input;
  input.width = width, input.height = height;
  input.camera = headCamera(character, preset);
  input.light = preset.scene.light;
  input.light.shadow_size = std::min(input.light.shadow_size, kPictureShadow);
  input.view = preset.scene.view;
  input.view.ground = false;
  input.hairs = preset.hairs;
  input.bodies = preset.bodies;
  return input;
}

}  // namespace app
