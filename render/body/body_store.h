// What the GPU keeps of every body: meshes, root covers, joint matrices, look. Meshes are uploaded once per mesh id,
// root covers once per mesh and scalp id, joint matrices when the pose changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/body/body_mesh.h"
#include "render/frame_input.h"
#include "render/gl/gl_object.h"
#include "render/view_math.h"

namespace render {

// What a body's uniform block is made of.
struct BodyFinish {
  Float3 color{}, root_color{};
  float roughness = 0, scalp_tint = 0;
  Float3 face_origin{};
  float face_height = 0, face_paint = 0;
  Float3 cloth_color{};
  bool dressed = true, own_materials = false;
  bool operator==(const BodyFinish&) const = default;
};

struct Body {
  std::uint64_t id = 0, mesh_id = 0, pose_revision = ~std::uint64_t{0};
  bool seen = false;  // shown by the present frame
  Buffer joints, block;
  Texture joint_texture;
  int joint_count = 0;
  long joint_bytes = 0;  // of the joints' buffer
  BodyFinish finish;
  std::uint64_t scalp_id = 0;        // 0: bare
  std::uint64_t hair_id = 0;         // that shades it; 0: none
  int level = 0;                     // of detail; 0 is the full mesh
  Bounds bounds;                     // world, of what hangs mostly on each joint
  std::uint64_t change = 0;          // of its pose, mesh or level
  std::vector<Mat4> joint_matrices;  // as uploaded

  // World bounds with a margin for what hangs on a joint by a small share.
  Bounds around() const;
};

class BodyStore {
 public:
  // Uploads new meshes, root covers and changed poses, frees what the frame no longer shows. Returns the bytes
  // uploaded. A body whose spans disagree in length, whose indices point outside or whose matrices are not finite is
  // not drawn; a root cover that does not have two numbers for each vertex is left out.
  long update(std::span<const BodyInput> inputs);

  // Chooses how finely each body is drawn, by its size in the picture if `follow_size`. Call after every update.
  void chooseDetail(const CameraInput& camera, int height, bool follow_size);

  std::span<const Body> bodies() const { return bodies_; }
  const BodyMesh& meshOf(const Body& body) const;

  // World bounds of all bodies; empty without bodies.
  const Bounds& bounds() const { return bounds_; }
  // Of the bodies that are not much farther from the eye than the nearest one.
  Bounds boundsNear(const Eigen::Vector3f& eye) const;
  // Changes whenever what the bodies' depth shows changes; with a light's matrix, only of bodies that it can show.
  std::uint64_t poseSignature(const Eigen::Matrix4f* clip_from_world = nullptr) const;
  // Changes whenever colours, roughness or tint of a body change.
  std::uint64_t lookSignature() const { return look_changes_; }

  // Binds a body's vertices, matrices and block for a draw.
  void bind(const Body& body, const BodyMesh& mesh) const;
  // Draws a bound body at its level of detail.
  static void drawLevel(const Body& body, const BodyMesh& mesh);
  // Draws all bodies with the program in use, whose uniform 0 is set to the matrix. `cull` leaves out bodies that
  // neither stand in the light's view nor between it and the light. Returns the draw calls.
  int drawAll(const Eigen::Matrix4f& clip_from_world, bool cull) const;

 private:
  // What hair roots cover of a mesh; bodies of one mesh under one haircut share it.
  struct Scalp {
    std::uint64_t mesh_id = 0, id = 0;
    bool seen = false;
    Buffer cover;
  };

  const BodyMesh& meshOf(const BodyInput& input, long& uploaded);
  // The id of the body's scalp on the GPU; 0 where it has none.
  std::uint64_t scalpOf(const BodyInput& input, long& uploaded);
  void refreshLook(Body& body, const BodyMesh& mesh, const BodyInput& input, long& uploaded);
  bool refreshPose(Body& body, const BodyMesh& mesh, const BodyInput& input, long& uploaded);

  std::vector<BodyMesh> meshes_;
  std::vector<Scalp> scalps_;
  std::vector<Body> bodies_;
  Bounds bounds_;
  std::uint64_t changes_ = 0, look_changes_ = 0;
};

// Bounds of a box moved by a matrix.
void addMoved(const Mat4& matrix, const Bounds& box, Bounds& sum);

}  // namespace render
