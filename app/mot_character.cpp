// ARCSim's mannequin: one rigid mesh a body, one joint a body, no hierarchy.
#include <charconv>
#include <cmath>
#include <filesystem>

#include "app/character_build.h"
#include "app/errors.h"
#include "app/motion.h"
#include "app/text_scanner.h"

namespace app {

namespace {

struct PartMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// What the sixteen bodies of the paper's mannequin are (README of its data); other counts are numbered.
constexpr std::array<const char*, 16> kBodyNames{"head",          "left_upper_arm", "right_upper_arm", "left_forearm",
                                                 "right_forearm", "chest",          "waist",           "pelvis",
                                                 "left_thigh",    "right_thigh",    "left_shin",       "right_shin",
                                                 "left_foot",     "right_foot",     "left_hand",       "right_hand"};

struct LineReader {
  std::string_view line;
  const std::string& file;
  int number;

  [[noreturn]] void fail(const std::string& fault, const std::string& mend) const {
    throw InputError(file, "line " + std::to_string(number), fault, mend);
  }
  std::string_view word() {
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    const auto last = std::min(line.find_first_of(" \t\r", first), line.size());
    const std::string_view w = line.substr(first, last - first);
    line.remove_prefix(last);
    return w;
  }
  double coordinate() {
    const std::string_view w = word();
    double value = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || end != w.data() + w.size() || !(std::abs(value) < 1e3))
      fail(quoted(w).append(" is no coordinate below 1000 m"), "write a vertex as three numbers");
    return value;
  }
  // A corner 'v', 'v/t' or 'v/t/n', negative counts from the end.
  std::uint32_t corner(std::string_view w, std::size_t vertices) const {
    long index = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), index);
    const bool whole = end == w.data() + w.size() || *end == '/';
    if (index < 0) index += static_cast<long>(vertices) + 1;
    if (error != std::errc() || !whole || index < 1 || index > static_cast<long>(vertices))
      fail("face corner " + quoted(w) + " names no vertex above it", "number vertices from 1");
    return static_cast<std::uint32_t>(index - 1);
  }
};

PartMesh readPart(const std::string& file) {
  const std::string text = readText(file);
  PartMesh mesh;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    LineReader reader{std::string_view(text).substr(at, end - at), file, ++number};
    at = end + 1;
    const std::string_view kind = reader.word();
    if (kind == "v") {
      const double x = reader.coordinate(), y = reader.coordinate(), z = reader.coordinate();
      mesh.vertices.emplace_back(x, y, z);
    } else if (kind == "f") {
      std::vector<std::uint32_t> corners;
      for (std::string_view w = reader.word(); !w.empty(); w = reader.word())
        corners.push_back(reader.corner(w, mesh.vertices.size()));
      if (corners.size() < 3) reader.fail("a face of fewer than three corners", "remove or complete it");
      for (std::size_t k = 2; k < corners.size(); ++k)
        mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
  }
  if (mesh.triangles.empty())
    throw InputError(file, "", "holds no faces", "give one closed mesh a body, in the body's own frame");
  return mesh;
}

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

}  // namespace

Character loadRigidParts(const std::string& text, const std::string& file, const std::string& parts_dir) {
  if (parts_dir.empty())
    throw InputError(file, "", "rigid body motion has no meshes of its own",
                     "name the folder of body0000.obj, body0001.obj ... with --parts");
  const RigidMotion motion = readMot(text, file);
  std::vector<PartMesh> parts;
  for (int b = 0; b < motion.body_count; ++b) {
    char name[32];
    std::snprintf(name, sizeof name, "body%04d.obj", b);
    parts.push_back(readPart((std::filesystem::path(parts_dir) / name).string()));
  }

  Character character;
  Clip clip;
  clip.name = std::filesystem::path(file).stem().string();
  clip.frame_time = motion.frame_time;
  clip.joint_count = motion.body_count;
  for (const Rigid& body : motion.bodies) {
    clip.rotations.emplace_back(body.linear());
    clip.translations.push_back(body.translation());
  }
  const bool known = parts.size() == kBodyNames.size();
  // The rest pose is the motion's first frame turned to face +z, standing over the origin.
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
  character.clips.push_back(std::move(clip));

  // Body 0 is the head; its frame follows its own axes, not the lean of the first frame.
  const Rigid& head = character.skeleton.joints[0].rest_world;
  const Vec3 up = nearestAxis(head, Vec3::UnitY()), ahead = nearestAxis(head, Vec3::UnitZ());
  character.head_joint = 0;
  character.head_frame.linear().col(0) = up.cross(ahead);
  character.head_frame.linear().col(1) = up;
  character.head_frame.linear().col(2) = ahead;
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
