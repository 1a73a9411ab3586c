// Draws strands that compute shaders have grown: once for the picture, where they are lit too, and once for each shadow map,
// whose depth and opacity are drawn from the same points. The buffers hold a batch of strands at a time: their size does not
// depend on how many there are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/gl/shader.h"
#include "render/gl/stored_buffer.h"
#include "render/hair/strand_draw.h"
#include "render/stage.h"

namespace render {

// Of the picture.
class GrownStrands {
 public:
  explicit GrownStrands(const std::string& shader_dir);
  // Draws all hairs in view into the radiance.
  StrandCount draw(Stage& stage);
  ReloadReport reload(Reload which) { return reloadPrograms({&grow_, &shade_, &show_}, which); }

 private:
  // Strands of one hair that lie in the buffers.
  struct Piece {
    std::size_t hair;
    int first, strands, stride;
    std::uint32_t first_strand, first_point;  // in the buffers
  };

  void add(std::size_t hair, int strands, int stride, Stage& stage);
  void drawBatch(Stage& stage);
  void bind(Stage& stage, const Piece& piece);

  ShaderProgram grow_, shade_, show_;
  VertexArray no_attributes_;
  StoredBuffer ribbons_, strands_, points_, colors_;
  std::vector<Piece> batch_;
  std::uint32_t strand_count_ = 0, point_count_ = 0;  // of the batch
};

// Of shadow maps.
class GrownLines {
 public:
  explicit GrownLines(const std::string& shader_dir);
  // Draw a bound hair's strands into the map that is begun: first their depth, then, as they stood there, their
  // opacity.
  void drawDepth(const HairResources& hair) { draw(hair, depth_, true); }
  void drawOpacity(const HairResources& hair) { draw(hair, opacity_, false); }
  ReloadReport reload(Reload which) { return reloadPrograms({&grow_, &depth_, &opacity_}, which); }

 private:
  void draw(const HairResources& hair, const ShaderProgram& program, bool fresh);

  ShaderProgram grow_, depth_, opacity_;
  VertexArray no_attributes_;
  StoredBuffer strands_, points_;
};

}  // namespace render
