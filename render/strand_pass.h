// Draws strands, lit, into the bound colour target: by the geometry stage or by vertex pulling, the same curves either
// way.
#pragma once

#include <string>

#include "render/frame_input.h"
#include "render/hair_store.h"
#include "render/shader.h"

namespace render {

// What a pass over a hair issued.
struct StrandCount {
  long strands = 0, vertices = 0, draw_calls = 0;
  StrandCount& operator+=(const StrandCount& other);
};

// Issues a hair's strands with the program in use. The geometry path draws points, the pulling path `strip` instances
// of `vertices_a_point` vertices a curve point. The hair must be bound.
struct StrandTopology {
  GLenum strip;
  int vertices_a_point;
};
StrandCount issueStrands(const HairResources& hair, const HairDraw& draw, StrandPath path,
                         const StrandTopology& topology);

class StrandPass {
 public:
  explicit StrandPass(const std::string& shader_dir);

  // Reads the frame block and the shadow maps, which must be bound. shadow_map: the hair's own, or -1. table: of the
  // frame's detail.
  StrandCount draw(HairResources& hair, int shadow_map, StrandPath path, const Texture& table);

  std::string reload();

 private:
  ShaderProgram geometry_, pulling_;
  VertexArray no_attributes_;
};

}  // namespace render
