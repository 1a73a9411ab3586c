#include "app/figure/character.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/figure/arm_clearance.h"
#include "app/figure/character_build.h"
#include "app/figure/face_mesh.h"
#include "app/figure/hand_mesh.h"
#include "app/figure/kept.h"
#include "app/figure/mannequin_field.h"
#include "app/figure/mannequin_parts.h"
#include "app/figure/skin_cover.h"
#include "app/files/errors.h"
#include "app/files/file_ending.h"
#include "app/files/polygon_file.h"
#include "app/files/text_file.h"
#include "app/motion/clip_repair.h"
#include "app/motion/foot_plant.h"
#include "app/motion/frozen_hands.h"
#include "app/motion/motion.h"

namespace app {

namespace {

enum class Kind { kBvh, kMot, kModel, kUnknown };

// By ending; hair meshes are refused. What has another than .bvh or .mot is looked into: a motion may be named as a
// model.
Kind kindOf(const std::string& file) {
  const std::string ending = endingOf(file);
  if (ending == ".bvh") return Kind::kBvh;
  if (ending == ".mot") return Kind::kMot;
  const std::string begin = readText(file).substr(0, 256);
  if (begin.find("HIERARCHY") != std::string::npos) return Kind::kBvh;
  if (begin.find("NumFrames") != std::string::npos) return Kind::kMot;
  if (ending == ".obj" && hasLayers(readText(file)))
    throw InputError(file, "", "is a hair mesh, no figure", "give it to --hair");
  for (const char* model : {".glb", ".gltf", ".fbx", ".dae", ".obj"})
    if (ending == model) return Kind::kModel;
  return Kind::kUnknown;
}

void cover(Character& character) {
  const CoverReport report = coverSkin(character);
  if (!report.unfit.empty())
    character.notes.push_back("no ellipsoids fit " + report.unfit + ": signed distances of their skin in their place");
  if (report.where.empty()) return;  // nothing else is in reach
  char note[300];
  std::snprintf(note, sizeof note,
                "skin below the chin that hair reaches sticks out of %zu ellipsoids by %.1f mm at most (%s; %.1f mm "
                "before %d were added); they lie over it by %.1f mm on average (%.1f mm before)",
                character.ellipsoids.size(), 1e3 * report.after, report.where.c_str(), 1e3 * report.before,
                report.added, 1e3 * report.over, 1e3 * report.over_before);
  character.notes.push_back(note);
}

void addNose(const BodyField& field, Character& character) {
  const Rigid to_joint = character.skeleton.joints[static_cast<std::size_t>(character.head_joint)].rest_world.inverse();
  for (const HeadEllipsoid& of_head : noseEllipsoids()) {
    BodyEllipsoid part{"nose", character.head_joint};
    part.center = to_joint * Vec3(field.head_origin + field.head_scale * of_head.center);
    part.rotation = Eigen::Quaterniond(to_joint.linear()) * Eigen::AngleAxisd(of_head.turn, Vec3::UnitX());
    part.radii = field.head_scale * of_head.radii;
    character.nose.push_back(part);
  }
}

}  // namespace

Character loadMannequin(const std::string& text, const std::string& file, SkinnedMesh& drawn) {
  BvhMotion motion = readBvh(text, file);
  Mannequin mannequin = growMannequin(motion, file);
  Character character;
  std::vector<BodyPart> parts = mannequinParts(mannequin);
  character.skeleton = std::move(mannequin.skeleton);
  character.mesh = std::move(mannequin.mesh);
  character.clips.push_back(std::move(motion.clip));
  character.head_joint = mannequin.roles.head;
  character.head_frame = mannequin.head_frame;
  character.face = {mannequin.field.head_origin, mannequin.field.head_scale};
  character.notes = std::move(motion.notes);
  character.notes.insert(character.notes.end(), mannequin.notes.begin(), mannequin.notes.end());

  const Vec3 origin = character.skeleton.joints[character.head_joint].rest_world.translation();
  const auto inScalp = [&](const Vec3& q) {
    return Vec3(mannequin.field.head_origin + mannequin.field.head_scale * q - origin);
  };
  const HeadMeasure measure{inScalp({0, 0, 0}).y(), inScalp({0, 1, 0}).y(), inScalp({0, 0.585, -0.045})};
  sampleHead(&measure, character);
  fitParts(std::move(parts), character);
  addNose(mannequin.field, character);
  drawn = withFineFace(withFingers(character.mesh, mannequin.field), mannequin.field);
  return character;
}

namespace {

// Of a motion or a model, with its clips mended; `text` of a motion is what the file holds.
Character makeCharacter(Kind kind, const std::string& text, const std::string& motion_file,
                        const std::string& parts_dir, const std::string& told) {
  Character character;
  SkinnedMesh drawn;
  switch (kind) {
    case Kind::kBvh:
      character = loadMannequin(text, motion_file, drawn);
      break;
    case Kind::kMot:
      character = loadRigidParts(text, motion_file, parts_dir);
      break;
    case Kind::kModel:
      character = importSkinned(motion_file, told);
      break;
    case Kind::kUnknown:
      throw InputError(motion_file, "", "is no motion or character that is known here",
                       "give a .bvh, .mot, .glb, .gltf, .fbx, .dae or .obj file");
  }
  character.name = std::filesystem::path(motion_file).stem().string();
  for (Clip& clip : character.clips) {
    const std::string of = character.clips.size() > 1 ? "clip " + clip.name + ": " : "";
    for (const std::string& note : repairClip(character.skeleton, clip)) character.notes.push_back(of + note);
    if (const std::string note = frozenHands(character.skeleton, clip); !note.empty())
      character.notes.push_back(of + note);
    if (const std::string note = plantFeet(character.skeleton, clip); !note.empty())
      character.notes.push_back(of + note);
    if (const std::string note = clearArms(character, clip); !note.empty()) character.notes.push_back(of + note);
  }
  cover(character);
  if (!drawn.positions.empty()) character.mesh = std::move(drawn);
  return character;
}

}  // namespace

Character loadCharacter(const std::string& motion_file, const std::string& parts_dir, const std::string& told) {
  const Kind kind = kindOf(motion_file);
  if (!parts_dir.empty() && kind != Kind::kMot)
    throw InputError(motion_file, "", "has no use for the rigid parts of '" + parts_dir + "'",
                     "give --parts with an ARCSim .mot motion only");
  static Kept<Character> mannequins;
  if (!told.empty() && kind != Kind::kModel && kind != Kind::kUnknown)
    throw InputError(motion_file, "", "is a motion, and '" + told.substr(0, 80) + "' is told of a body without bones",
                     "leave out --body, or the scene's \"body\"");
  if (kind == Kind::kBvh) {
    const std::string text = readText(motion_file);
    return mannequins.get(motion_file + '\n' + text, [&] { return makeCharacter(kind, text, motion_file, {}, {}); });
  }
  return makeCharacter(kind, kind == Kind::kMot ? readText(motion_file) : "", motion_file, parts_dir, told);
}

Rigid scalpToWorld(const Character& character, const Pose& pose) {
  return pose.world[character.head_joint] * character.head_frame;
}

void poseEllipsoid(const BodyEllipsoid& part, const Pose& pose, const Pose& previous, double dt, sim::Ellipsoid& e) {
  const Rigid& now = pose.world[part.joint];
  e.center = now * part.center;
  e.rotation = (Eigen::Quaterniond(now.linear()) * part.rotation).normalized();
  e.radii = part.radii;
  e.velocity.setZero();
  e.angular_velocity.setZero();
  if (!(dt > 0) || previous.world.size() != pose.world.size()) return;
  const Rigid& before = previous.world[part.joint];
  e.velocity = (e.center - before * part.center) / dt;
  // The shorter way round: of a turn and its complement, joints take the smaller.
  const Eigen::AngleAxisd turn(
      Eigen::Quaterniond(Eigen::Matrix3d(now.linear() * before.linear().transpose())).normalized());
  const double angle = std::remainder(turn.angle(), 2 * EIGEN_PI);
  e.angular_velocity = turn.axis() * (angle / dt);
}

void poseEllipsoids(const Character& character, const Pose& pose, const Pose& previous, double dt,
                    std::vector<sim::Ellipsoid>& ellipsoids) {
  ellipsoids.resize(character.ellipsoids.size());
  for (std::size_t i = 0; i < ellipsoids.size(); ++i)
    poseEllipsoid(character.ellipsoids[i], pose, previous, dt, ellipsoids[i]);
}

}  // namespace app
