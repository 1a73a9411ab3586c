// Draws strands, lit: by the geometry stage or by vertex pulling, the same curves either way.
#pragma once

#include <string>

#include "render/pass.h"
#include "render/strand_draw.h"

namespace render {

class StrandPass {
 public:
  static constexpr const char* kName = "strands";
  struct Input {
    bool show = true;
    StrandPath path = StrandPath::kGeometry;
    bool operator==(const Input&) const = default;
  };
  static Input inputOf(const FrameInput& frame) { return {frame.view.show_strands, frame.view.strand_path}; }

  explicit StrandPass(const std::string& shader_dir);
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload which) { return reloadPrograms({&geometry_, &pulling_}, which); }

 private:
  ShaderProgram geometry_, pulling_;
  VertexArray no_attributes_;
};

}  // namespace render
