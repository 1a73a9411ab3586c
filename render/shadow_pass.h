// The key light's shadow maps, as shadow_maps.h plans them; maps that show already what they should are kept.
#pragma once

#include <string>

#include "render/pass.h"
#include "render/shadow_maps.h"
#include "render/strand_draw.h"

namespace render {

// Deep opacity maps of the hairs, and the bodies' depth in the same views.
class HairShadowPass {
 public:
  static constexpr const char* kName = "hair shadows";
  struct Input {
    bool keep_maps = true, cull_bodies = true;
    StrandPath path = StrandPath::kGeometry;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) {
    return {frame.skips.shadows, frame.skips.shadow_view, frame.view.strand_path};
  }

  explicit HairShadowPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which);

 private:
  // Draws a bound hair into a map.
  void drawStrands(const Input& input, const HairResources& hair, ShaderProgram& geometry,
                   ShaderProgram& pulling) const;

  ShaderProgram depth_geometry_, depth_pulling_, opacity_geometry_, opacity_pulling_, body_depth_;
  VertexArray no_attributes_;
};

// Depth of the bodies.
class BodyShadowPass {
 public:
  static constexpr const char* kName = "body shadow";
  struct Input {
    bool keep_maps = true;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.skips.shadows}; }

  explicit BodyShadowPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return depth_.reload(which); }

 private:
  ShaderProgram depth_;
};

}  // namespace render
