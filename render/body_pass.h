// Skinned bodies: rest meshes uploaded once per mesh id, joint matrices when the pose changed, skinning in the vertex
// stage.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "render/frame_input.h"
#include "render/gl_object.h"
#include "render/shader.h"
#include "render/view_math.h"

namespace render {

class BodyPass {
 public:
  explicit BodyPass(const std::string& shader_dir);

  // Uploads new meshes and changed poses, frees what the frame no longer shows. Returns the bytes uploaded. A body
  // whose spans disagree in length, whose indices point outside or whose matrices are not finite is not drawn.
  long update(std::span<const BodyInput> inputs);

  // World bounds of all bodies (joint boxes, a little too large); empty without bodies.
  const Bounds& bounds() const { return bounds_; }
  // Changes whenever what the bodies' depth shows changes.
  std::uint64_t poseSignature() const { return pose_signature_; }

  int draw(const Eigen::Matrix4f& clip_from_world);       // lit; returns the draw calls
  int drawDepth(const Eigen::Matrix4f& clip_from_world);  // depth only

  std::string reload();

 private:
  struct Mesh {
    std::uint64_t id = 0;
    bool seen = false;
    Buffer vertices, indices;
    VertexArray attributes;
    int index_count = 0, joint_count = 0;
    std::vector<Bounds> joint_boxes;  // rest pose
  };
  struct Body {
    std::uint64_t id = 0, mesh_id = 0, pose_revision = ~std::uint64_t{0};
    bool seen = false;
    Buffer joints, block;
    Texture joint_texture;
    int joint_count = 0;
    Float3 color{};
    float roughness = 0;
    Bounds bounds;
  };

  Mesh* meshOf(const BodyInput& input, long& uploaded);
  bool refreshPose(Body& body, const Mesh& mesh, const BodyInput& input, long& uploaded);
  int issue(const Eigen::Matrix4f& clip_from_world);

  ShaderProgram lit_, depth_;
  std::vector<Mesh> meshes_;
  std::vector<Body> bodies_;
  Bounds bounds_;
  std::uint64_t pose_signature_ = 0, changes_ = 0;
};

}  // namespace render
