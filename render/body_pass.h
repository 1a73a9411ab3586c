// Skinned bodies: rest meshes uploaded once per mesh id, root covers once per scalp id, joint matrices when the pose
// changed; skinning in the vertex stage.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/body_detail.h"
#include "render/frame_input.h"
#include "render/gl_object.h"
#include "render/renderer.h"
#include "render/shader.h"
#include "render/view_math.h"

namespace render {

class BodyPass {
 public:
  explicit BodyPass(const std::string& shader_dir);

  // Uploads new meshes, root covers and changed poses, frees what the frame no longer shows. Returns the bytes uploaded.
  // A body whose spans disagree in length, whose indices point outside or whose matrices are not finite is not drawn; a
  // root cover that does not have two numbers for each vertex is left out.
  long update(std::span<const BodyInput> inputs);

  // Chooses how finely each body is drawn, by its size in the picture. Call after every update.
  void chooseDetail(const FrameInput& input);

  // World bounds of all bodies (joint boxes, a little too large); empty without bodies.
  const Bounds& bounds() const { return bounds_; }
  // Of the bodies that are not much farther from the eye than the nearest one.
  Bounds boundsNear(const Eigen::Vector3f& eye) const;
  // Changes whenever what the bodies' depth shows changes; with a light's matrix, only of bodies that it can show.
  std::uint64_t poseSignature(const Eigen::Matrix4f* clip_from_world = nullptr) const;
  // Changes whenever what the bodies' picture shows changes.
  std::uint64_t lookSignature() const { return look_changes_; }

  // Lit; returns the draw calls. Bodies and parts outside the view are left out as `skips` says.
  int draw(const Eigen::Matrix4f& clip_from_world, const DrawSkips& skips, DrawLeftOut& left_out);
  // Depth only; `cull` leaves out bodies beside or behind what the light's matrix shows.
  int drawDepth(const Eigen::Matrix4f& clip_from_world, bool cull);

  std::string reload();

 private:
  // Triangles whose first corner hangs mostly on one joint.
  struct Part {
    int first_index = 0, index_count = 0;
    std::vector<int> joints;    // that move any of its vertices
    std::vector<Bounds> boxes;  // of the vertices that each moves, rest pose
  };
  struct IndexRange {
    int first = 0, count = 0;
  };
  struct Mesh {
    std::uint64_t id = 0;
    bool seen = false;
    std::vector<Part> parts;
    Buffer vertices, indices;
    VertexArray attributes;
    int index_count = 0, joint_count = 0;
    std::array<IndexRange, kBodyCells.size() + 1> levels;  // full, then ever coarser
    std::vector<Bounds> joint_boxes;                       // rest pose
  };
  // What hair roots cover of a mesh; bodies of one mesh under one haircut share it.
  struct Scalp {
    std::uint64_t mesh_id = 0, id = 0;
    bool seen = false;
    Buffer cover;
  };
  // What a body's block is made of.
  struct Finish {
    Float3 color{}, root_color{};
    float roughness = 0, scalp_tint = 0;
    bool operator==(const Finish&) const = default;
  };
  struct Body {
    std::uint64_t id = 0, mesh_id = 0, pose_revision = ~std::uint64_t{0};
    bool seen = false;
    Buffer joints, block;
    Texture joint_texture;
    int joint_count = 0;
    Finish finish;
    std::uint64_t scalp_id = 0;  // 0: bare
    int level = 0;  // of detail
    Bounds bounds;
    std::uint64_t change = 0;          // of its pose or mesh
    std::vector<Mat4> joint_matrices;  // as uploaded
  };

  Mesh* meshOf(const BodyInput& input, long& uploaded);
  // The id of the body's scalp on the GPU; 0 where it has none.
  std::uint64_t scalpOf(const BodyInput& input, long& uploaded);
  void refreshLook(Body& body, const BodyInput& input, long& uploaded);
  bool refreshPose(Body& body, const Mesh& mesh, const BodyInput& input, long& uploaded);
  const Mesh& meshOf(const Body& body) const;
  void bind(const Body& body, const Mesh& mesh) const;
  static void drawLevel(const Body& body, const Mesh& mesh);

  ShaderProgram lit_, lit_small_, depth_;
  std::vector<Mesh> meshes_;
  std::vector<Scalp> scalps_;
  std::vector<Body> bodies_;
  Bounds bounds_;
  std::uint64_t pose_signature_ = 0, changes_ = 0, look_changes_ = 0;
  std::vector<int> counts_;
  std::vector<const void*> offsets_;
};

}  // namespace render
