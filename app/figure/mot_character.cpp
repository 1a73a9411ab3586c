// ARCSim's mannequin: one rigid mesh a body, one joint a body, no hierarchy.
#include <cmath>
#include <filesystem>

#include "app/figure/bone_mesh.h"
#include "app/figure/character_build.h"
#include "app/files/errors.h"
#include "app/files/text_file.h"
#include "app/motion/motion.h"

namespace app {

namespace {

// What the sixteen bodies of the paper's mannequin are (README of its data); other counts are numbered.
constexpr std::array<const char*, 16> kBodyNames{"head",          "left_upper_arm", "right_upper_arm", "left_forearm",
                                                 "right_forearm", "chest",          "waist",           "pelvis",
                                                 "left_thigh",    "right_thigh",    "left_shin",       "right_shin",
                                                 "left_foot",     "right_foot",     "left_hand",       "right_hand"};

void appendPart(const PartMesh& part, int joint, const Rigid& rest, SkinnedMesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<Vec3> normals(part.vertices.size(), Vec3::Zero());
  for (const auto& t : part.triangles) {
    const Vec3 n = (part.vertices[t[1]] - part.vertices[t[0]]).cross(part.vertices[t[2]] - part.vertices[t[0]]);
    for (const std::uint32_t v : t) normals[v] += n;
    for (const std::uint32_t v : t) mesh.triangles.push_back(base + v);
  }
  for (std::size_t v = 0; v < part.vertices.size(); ++v) {
    const double length = normals[v].norm();
    mesh.positions.push_back((rest * part.vertices[v]).cast<float>());
    mesh.normals.push_back(
        (rest.linear() * (length > 0 ? Vec3(normals[v] / length) : Vec3(Vec3::UnitY()))).cast<float>());
    mesh.joints.push_back({static_cast<std::uint16_t>(joint), 0, 0, 0});
    mesh.weights.push_back({1, 0, 0, 0});
  }
}

// The body's own axis (+-x, +-y or +-z) that points most nearly along a world direction in the rest pose: meshes are
// modelled along their axes, poses lean a little.
Vec3 nearestAxis(const Rigid& rest, const Vec3& world) {
  const Vec3 local = rest.linear().transpose() * world;
  int axis = 0;
  local.cwiseAbs().maxCoeff(&axis);
  return std::copysign(1.0, local[axis]) * Vec3::Unit(axis);
}

// Where the figure faces: from the shins' lower ends to the feet's tips; without sixteen bodies, the world's +x, which
// is forward in ARCSim's data.
Vec3 facing(const std::vector<PartMesh>& parts, const RigidMotion& motion) {
  if (parts.size() != kBodyNames.size()) return Vec3::UnitX();
  Vec3 forward = Vec3::Zero();
  for (const int foot : {12, 13}) {
    Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);
    for (const Vec3& v : parts[foot].vertices) {
      low = low.cwiseMin(motion.bodies[foot] * v);
      high = high.cwiseMax(motion.bodies[foot] * v);
    }
    Vec3 ankle = Vec3(0, 1e9, 0);
    for (const Vec3& v : parts[foot - 2].vertices)
      if ((motion.bodies[foot - 2] * v).y() < ankle.y()) ankle = motion.bodies[foot - 2] * v;
    forward += 0.5 * (low + high) - ankle;
  }
  forward.y() = 0;
  return forward.norm() > 1e-3 ? Vec3(forward.normalized()) : Vec3(Vec3::UnitX());
}

std::vector<PartMesh> readParts(const std::string& folder, int count) {
  std::vector<PartMesh> parts;
  for (int b = 0; b < count; ++b) {
    char name[32];
    std::snprintf(name, sizeof name, "body%04d.obj", b);
    const std::string part = (std::filesystem::path(folder) / name).string();
    parts.push_back(readPart(readText(part), part));
  }
  return parts;
}

Clip clipOf(const RigidMotion& motion, const std::string& file) {
  Clip clip;
  clip.name = std::filesystem::path(file).stem().string();
  clip.frame_time = motion.frame_time;
  clip.joint_count = motion.body_count;
  for (const Rigid& body : motion.bodies) {
    clip.rotations.emplace_back(body.linear());
    clip.translations.push_back(body.translation());
  }
  return clip;
}

// One joint and one rigid mesh a body. The rest pose is the motion's first frame turned to face +z, over the origin.
void addSkeleton(const RigidMotion& motion, const std::vector<PartMesh>& parts, Character& character) {
  const bool known = parts.size() == kBodyNames.size();
  const Vec3 forward = facing(parts, motion);
  const Vec3 over = motion.bodies[known ? 7 : 0].translation();
  Rigid stand = Rigid::Identity();
  stand.linear() = Eigen::AngleAxisd(-std::atan2(forward.x(), forward.z()), Vec3::UnitY()).toRotationMatrix();
  stand.translation() = -(stand.linear() * Vec3(over.x(), 0, over.z()));
  for (int b = 0; b < motion.body_count; ++b) {
    Joint joint;
    joint.name = known ? std::string(kBodyNames[b]) : std::string("body").append(std::to_string(b));
    joint.rest_local = joint.rest_world = stand * motion.bodies[b];
    appendPart(parts[b], b, joint.rest_world, character.mesh);
    character.skeleton.joints.push_back(std::move(joint));
  }
}

// Body 0 is the head. Its frame follows its own axes, not the lean of the first frame.
void setHeadFrame(Character& character) {
  const Rigid& head = character.skeleton.joints[0].rest_world;
  const Vec3 up = nearestAxis(head, Vec3::UnitY()), ahead = nearestAxis(head, Vec3::UnitZ());
  character.head_joint = 0;
  character.head_frame.linear().col(0) = up.cross(ahead);
  character.head_frame.linear().col(1) = up;
  character.head_frame.linear().col(2) = ahead;
}

}  // namespace

Character loadRigidParts(const std::string& text, const std::string& file, const std::string& parts_dir) {
  if (parts_dir.empty())
    throw InputError(file, "", "rigid body motion has no meshes of its own",
                     "name the folder of body0000.obj, body0001.obj ... with --parts");
  const RigidMotion motion = readMot(text, file);
  Character character;
  addSkeleton(motion, readParts(parts_dir, motion.body_count), character);
  character.clips.push_back(clipOf(motion, file));
  setHeadFrame(character);
  sampleHead(nullptr, character);

  const std::vector<FitPoint> points = surfacePoints(character.mesh);
  std::vector<BodyPart> bodies(motion.body_count);
  for (std::size_t v = 0; v < points.size(); ++v) bodies[character.mesh.joints[v][0]].points.push_back(points[v]);
  for (int b = 0; b < motion.body_count; ++b) {
    bodies[b].name = character.skeleton.joints[b].name;
    bodies[b].joint = b;
  }
  fitParts(std::move(bodies), character);
  character.notes.insert(character.notes.begin(), {"unit: metres, z up, as ARCSim writes them",
                                                   "frame rate: 30 per second (the format does not say), " +
                                                       std::to_string(motion.frame_count) + " frames",
                                                   "head: body 0; rest pose: the first frame, turned to face +z"});
  return character;
}

}  // namespace app
