// A character: a skeleton, a skinned mesh, clips, collision ellipsoids and a scalp. Immutable once loaded; what moves
// is Pose.
//
// World: metres, y up, right-handed. Every file's units and axes are converted at load and reported in `notes`.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "app/styles/hair_styles.h"
#include "sim/contact/colliders.h"

namespace app {

using Vec3 = Eigen::Vector3d;
using Rigid = Eigen::Isometry3d;

struct Joint {
  std::string name;
  int parent = -1;                       // index of an earlier joint, or -1
  Rigid rest_local = Rigid::Identity();  // joint to parent, rest pose
  Rigid rest_world = Rigid::Identity();  // joint to model, rest pose (the bind pose of the mesh)
};

struct Skeleton {
  std::vector<Joint> joints;  // parents before children
};

// Joint-to-world transforms of one moment.
struct Pose {
  std::vector<Rigid> world;
};

// Local transforms of every joint at every frame.
struct Clip {
  std::string name;
  double frame_time = 1.0 / 60;  // s
  int joint_count = 0;
  std::vector<Eigen::Quaterniond> rotations;  // frames x joints
  std::vector<Vec3> translations;             // frames x joints, m
  int frameCount() const { return joint_count ? static_cast<int>(rotations.size()) / joint_count : 0; }
  double duration() const { return frame_time * (frameCount() > 1 ? frameCount() - 1 : 1); }
};

// Triangles with at most four joint weights a vertex (weights sum to 1). Positions and normals in the model's rest
// pose.
struct SkinnedMesh {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<std::uint32_t> triangles;  // three indices a triangle, counter-clockwise from outside
  std::vector<std::array<std::uint16_t, 4>> joints;
  std::vector<std::array<float, 4>> weights;
  std::vector<float> cloth;  // m from a garment's edge, negative under it; empty: bare
  // Colours that the file brings; empty: none. See mesh_materials.h.
  std::vector<Eigen::Vector3f> material_places;       // u to the right, v down; the material's number
  std::vector<std::vector<std::uint32_t>> materials;  // a square picture each, of one size: RGBA8, sRGB, top row first
};

// A collision ellipsoid fixed to a joint.
struct BodyEllipsoid {
  std::string name;  // "head", "neck", "chest", "left_upper_arm", ...
  int joint = 0;
  Vec3 center = Vec3::Zero();  // m, joint frame
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vec3 radii = Vec3::Ones();
  bool by_distances = false;  // it does not fit: signed distances (body_sdf.h) stand for its part
};

// Where a grown head's face lies, rest pose.
struct Face {
  Vec3 origin = Vec3::Zero();  // m: the chin's level under the base of the skull
  double height = 0;           // m from chin to crown; 0: the figure brings its own face
};

struct Character {
  std::string name;
  Skeleton skeleton;
  SkinnedMesh mesh;
  std::vector<Clip> clips;  // at least one
  std::vector<BodyEllipsoid> ellipsoids;
  std::vector<BodyEllipsoid> nose;  // drawn strands are lifted out of it; hair meshes do not collide with it
  int head_joint = 0;
  Rigid head_frame =
      Rigid::Identity();  // scalp frame (y up, z forward, x left, origin at the head joint) to head joint frame
  Scalp scalp;
  Face face;
  std::vector<std::string> notes;  // what was inferred: units, axes, frame rate, rest pose, head joint
  bool is_still = false;           // a body without bones
};

// Any clip and body: BVH (a mannequin is grown around it), glTF, FBX, Collada or OBJ (with its own mesh; one without a
// skeleton stands still), or ARCSim .mot with `parts_dir` holding body0000.obj ... Chosen by the file's ending and
// content. `told`: of a body without a skeleton, see readToldBody. Throws InputError.
Character loadCharacter(const std::string& motion_file, const std::string& parts_dir = "",
                        const std::string& told = "");

// Pose at `time` seconds into the clip; out-of-range times are clamped. Interpolates (slerp, lerp).
void samplePose(const Skeleton& skeleton, const Clip& clip, double time, Pose& pose);

// The rest pose.
Pose restPose(const Skeleton& skeleton);

// Signed distance (m, negative inside) to the body in its rest pose, for points in the scalp frame. Exact enough to
// grow hair on: within 2 mm near the surface.
BodyDistance restBodyDistance(const Character& character);

// The head's scalp-frame-to-world transform and the ellipsoids of a pose. `velocity` fields are filled from `previous`
// over dt when dt > 0.
Rigid scalpToWorld(const Character& character, const Pose& pose);
void poseEllipsoid(const BodyEllipsoid& part, const Pose& pose, const Pose& previous, double dt, sim::Ellipsoid& e);
void poseEllipsoids(const Character& character, const Pose& pose, const Pose& previous, double dt,
                    std::vector<sim::Ellipsoid>& ellipsoids);

}  // namespace app
