// Draws strands on drivers that rasterize in software: shaders grow, project and shade the points, strand_raster.h
// fills the samples between them. A strand is grown once, and only points that some sample shows are shaded.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/gl/shader.h"
#include "render/gl/stored_buffer.h"
#include "render/hair/strand_draw.h"
#include "render/software/strand_raster.h"
#include "render/stage.h"

namespace render {

class SoftwareStrands {
 public:
  explicit SoftwareStrands(const std::string& shader_dir);
  // Draws all hairs in view into the radiance. Returns false, and draws nothing, where they have more points or a pixel
  // more samples than it takes.
  // shade_all: also points that no sample shows. Adds those left unshaded to `unshaded`.
  bool draw(Stage& stage, bool shade_all, StrandCount& count, SkipCount& unshaded);
  ReloadReport reload(Reload which) { return reloadPrograms({&grow_, &shade_, &show_}, which); }

 private:
  // Where a hair's strands and points lie in the buffers.
  struct Placed {
    std::size_t hair = 0;
    int strands = 0, stride = 0;
    std::uint32_t first_strand = 0, first_point = 0, seen = 0, first_seen = 0;
  };

  // Returns false where there are too many points.
  bool place(Stage& stage);
  void grow(Stage& stage);
  PixelBox rasterize(const Stage& stage);
  void listSeen(bool all, SkipCount& unshaded);
  void shade(Stage& stage);
  void show(const PixelBox& box);
  void bind(Stage& stage, const Placed& placed);

  ShaderProgram grow_, shade_, show_;
  VertexArray no_attributes_;
  StoredBuffer ribbons_, strands_, points_, colors_, samples_;
  GrowingBuffer seen_buffer_;
  std::vector<Placed> placed_;
  std::uint32_t point_count_ = 0, strand_count_ = 0;
  std::vector<std::uint8_t> is_seen_;
  std::vector<int> seen_;  // points of a hair that are seen, hair by hair
  int width_ = 0, height_ = 0;
  PixelBox touched_;  // pixels that hold samples of the last picture
};

}  // namespace render
