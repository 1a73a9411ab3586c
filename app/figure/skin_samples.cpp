#include "app/figure/skin_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "app/figure/body_input.h"
#include "app/figure/character_build.h"
#include "app/figure/ellipsoid_fit.h"
#include "app/figure/fine_mesh.h"
#include "render/body/skinning.h"

namespace app {
namespace {

constexpr double kReach = 3.0;   // head heights from the head's middle, as far as hair comes
constexpr double kAside = 0.75;  // head heights from the head's axis, as far as the head reaches
constexpr double kChin = -0.585, kMouthBelow = -0.25, kMouthBefore = 0.18,
                 kNape = -0.30;           // the same, up and forward from its middle
constexpr double kAir = 0.014;            // m in front of the skin: nothing is to lie there but hair
constexpr double kClear = 0.006;          // m, that such a place is at least off the ellipsoids and other skin
constexpr float kFinestSpacing = 0.004f;  // m, spacing of samples
constexpr float kLongestEdge = 0.04f;     // m, of the skin whose vertices are sampled
constexpr double kAskedWithin = 0.04;     // m: skin so near is asked

// The rest pose, then moments evenly over all clips.
std::vector<Pose> momentsOf(const Character& character, int moments) {
  std::vector<Pose> poses{restPose(character.skeleton)};
  double duration = 0;
  for (const Clip& clip : character.clips) duration += clip.duration();
  const double apart = duration / moments;
  double at = 0, next = 0.5 * apart;
  for (const Clip& clip : character.clips) {
    for (; apart > 0 && next < at + clip.duration(); next += apart) {
      poses.emplace_back();
      samplePose(character.skeleton, clip, next - at, poses.back());
    }
    at += clip.duration();
  }
  return poses;
}

// Every vertex at every pose; poses are moved so that the head joint is at the origin, where single precision is exact.
std::vector<std::vector<Eigen::Vector3f>> skinnedAt(const SkinnedMesh& mesh, const Character& character,
                                                    std::vector<Pose>& poses) {
  render::BodyInput body;
  pointTo(mesh, body);
  std::vector<render::Mat4> carried(character.skeleton.joints.size());
  body.joint_matrices = carried;
  std::vector<std::vector<Eigen::Vector3f>> skins;
  for (Pose& pose : poses) {
    const Vec3 head = pose.world[static_cast<std::size_t>(character.head_joint)].translation();
    for (std::size_t j = 0; j < pose.world.size(); ++j) {
      pose.world[j].pretranslate(-head);
      const Rigid& rest = character.skeleton.joints[j].rest_world;
      Eigen::Map<Eigen::Matrix4f>(carried[j].data()) =
          (pose.world[j] * rest.inverse(Eigen::Isometry)).matrix().cast<float>();
    }
    skins.push_back(render::skinnedPositions(body));
  }
  return skins;
}

// Per joint: itself or the nearest above it that carries an ellipsoid; -1: none.
std::vector<int> carriersOf(const Character& character) {
  std::vector<int> carriers(character.skeleton.joints.size(), -1);
  for (const BodyEllipsoid& e : character.ellipsoids) carriers[static_cast<std::size_t>(e.joint)] = e.joint;
  for (std::size_t j = 0; j < carriers.size(); ++j) {
    const int parent = character.skeleton.joints[j].parent;
    if (carriers[j] < 0 && parent >= 0) carriers[j] = carriers[static_cast<std::size_t>(parent)];
  }
  return carriers;
}

double gapAtRest(const Character& character, const Vec3& p) {
  double gap = 1e9;
  for (const BodyEllipsoid& e : character.ellipsoids) {
    const Rigid& rest = character.skeleton.joints[static_cast<std::size_t>(e.joint)].rest_world;
    gap = std::min(gap, ellipsoidGap(e, rest.inverse(Eigen::Isometry) * p));
  }
  return gap;
}

// The first of the vertices in each cell of a grid at rest.
std::vector<std::size_t> oneACell(const SkinnedMesh& mesh, const std::vector<std::size_t>& vertices, float cell) {
  std::set<std::array<int, 3>> seen;
  std::vector<std::size_t> some;
  for (const std::size_t v : vertices) {
    const Eigen::Vector3i at = (mesh.positions[v] / cell).array().floor().cast<int>();
    if (seen.insert({at.x(), at.y(), at.z()}).second) some.push_back(v);
  }
  return some;
}

// Vertices, at most `most` of them and spread evenly, that come near at one of the moments; near: per moment and
// vertex.
std::vector<std::size_t> thinned(const SkinnedMesh& mesh, const std::vector<std::vector<unsigned char>>& near,
                                 std::size_t most) {
  std::vector<std::size_t> all;
  for (std::size_t v = 0; v < near.front().size(); ++v) {
    if (std::ranges::any_of(near, [&](const auto& moment) { return moment[v] != 0; })) all.push_back(v);
  }
  std::vector<std::size_t> some = all;
  for (float cell = kFinestSpacing; some.size() > most; cell *= 1.2f) some = oneACell(mesh, all, cell);
  return some;
}

// Whether a joint is the head's or hangs on it.
bool belongsToHead(const Skeleton& skeleton, int joint, int head) {
  while (joint >= 0 && joint != head) joint = skeleton.joints[static_cast<std::size_t>(joint)].parent;
  return joint == head;
}

void addSamples(const SkinnedMesh& mesh, const Character& character, const std::vector<std::size_t>& vertices,
                PosedSkin& skin) {
  const std::vector<FitPoint> points = surfacePoints(mesh);
  const std::vector<int> dominant = dominantJoints(mesh), carriers = carriersOf(character);
  const Rigid to_scalp = scalpToWorld(character, restPose(character.skeleton)).inverse(Eigen::Isometry);
  const double size = character.scalp.head_height;
  double area = 0;
  for (const std::size_t v : vertices) {
    const int carrier = carriers[static_cast<std::size_t>(dominant[v])];
    if (carrier < 0 || points[v].weight <= 0) continue;
    const Vec3 from = to_scalp * points[v].position - character.scalp.center;
    const bool mouth = from.y() < kMouthBelow * size && from.z() > kMouthBefore * size;
    // The neck bends below the nape's hairline, and its skin with it.
    const bool neck = from.y() < kNape * size && !belongsToHead(character.skeleton, carrier, character.head_joint);
    const bool of_head = from.y() > kChin * size && std::hypot(from.x(), from.z()) < kAside * size && !mouth && !neck;
    skin.samples.push_back(
        {points[v].position, mesh.normals[v].cast<double>(), points[v].weight, static_cast<int>(v), carrier, of_head});
    area += points[v].weight;
  }
  for (SkinSample& sample : skin.samples) sample.weight /= std::max(area, 1e-12);
}

// Places in front of samples that lie neither in an ellipsoid nor in, or close before, other skin.
void addAir(const Character& character, PosedSkin& skin) {
  for (const SkinSample& sample : skin.samples) {
    const Vec3 air = sample.rest + kAir * sample.normal;
    const bool taken = std::ranges::any_of(skin.samples, [&](const SkinSample& other) {
      const Vec3 apart = air - other.rest;
      return apart.squaredNorm() < kAskedWithin * kAskedWithin && apart.dot(other.normal) < kClear;
    });
    if (!taken && gapAtRest(character, air) > kClear) skin.air.push_back(air);
  }
}

}  // namespace

PosedSkin poseSkin(const Character& character, std::size_t most, int moments) {
  PosedSkin skin;
  if (character.ellipsoids.empty() || character.mesh.positions.empty()) return skin;
  std::vector<Pose> poses = momentsOf(character, moments);
  const SkinnedMesh mesh = withoutLongEdges(character.mesh, kLongestEdge);
  const auto skins = skinnedAt(mesh, character, poses);
  const double reach = kReach * character.scalp.head_height;
  std::vector<std::vector<unsigned char>> near;
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const Vec3 head = scalpToWorld(character, poses[m]) * character.scalp.center;
    near.emplace_back();
    for (const Eigen::Vector3f& p : skins[m]) near.back().push_back((p.cast<double>() - head).norm() < reach);
  }
  addSamples(mesh, character, thinned(mesh, near, most), skin);
  addAir(character, skin);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    skin.to_joint.emplace_back();
    for (const Rigid& joint : poses[m].world) skin.to_joint.back().push_back(joint.inverse(Eigen::Isometry));
    skin.world.emplace_back();
    for (const SkinSample& sample : skin.samples) {
      const auto v = static_cast<std::size_t>(sample.vertex);
      skin.world.back().push_back(skins[m][v].cast<double>());
      skin.reached.push_back(near[m][v]);
    }
  }
  return skin;
}

}  // namespace app
