// The bodies, lit.
#pragma once

#include <string>
#include <vector>

#include "render/body_store.h"
#include "render/pass.h"

namespace render {

class BodyPass {
 public:
  static constexpr const char* kName = "bodies";
  struct Input {
    bool show = true, cull_bodies = true, cull_parts = true;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) {
    return {frame.view.show_body, frame.skips.view, frame.skips.body_parts};
  }

  explicit BodyPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return reloadPrograms({&lit_, &lit_small_}, which); }

 private:
  // Fills counts_ and offsets_ with the triangles whose joint may be in view. Returns how many are left out.
  long chooseTriangles(const Body& body, const BodyMesh& mesh, const Frustum* cull);

  ShaderProgram lit_;        // per pixel
  ShaderProgram lit_small_;  // per vertex, for bodies of few pixels
  std::vector<int> counts_;
  std::vector<const void*> offsets_;
};

}  // namespace render
