// What the GPU keeps of every hair: positions and gradients, layout, scattering table, look. Kept by id, refilled only
// where something changed, freed when a frame no longer shows the hair.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/gl_object.h"
#include "render/hair_layout.h"
#include "render/hair_openness.h"
#include "render/view_math.h"

namespace render {

struct HairResources {
  std::uint64_t id = 0;
  std::uint64_t layout_revision = ~std::uint64_t{0}, position_revision = ~std::uint64_t{0};  // nothing uploaded yet
  HairLayout layout;
  HairOpenness openness;
  Bounds bounds;
  int strands = -1, segments = 0;
  HairLook look;
  Float3 forward_albedo{}, backward_albedo{}, local_back{};  // of the look; see fiber_scattering.h
  bool seen = false, drawable = false;                       // drawable: has faces and finite positions
  std::uint64_t shadow_revision = 0;                         // counts changes of anything that its shadow shows
  Buffer vertex_buffer, layout_buffer, block;
  Texture vertex_texture, layout_texture, scattering;
  GLsizeiptr vertex_bytes = 0, layout_bytes = 0;

  long gpuBytes() const;
};

// How a pass draws a hair: filled into its uniform block before the draw.
struct HairDraw {
  int stride = 1;       // draw every stride-th strand
  int segments = 1;     // a layer
  int shadow_map = -1;  // the hair's own deep opacity map

  int strandCount(const HairResources& hair) const { return (hair.strands + stride - 1) / stride; }
  int pointsPerStrand(const HairResources& hair) const { return (hair.layout.max_layers - 1) * segments + 1; }
  int chunksPerStrand(const HairResources& hair) const;
};

class HairStore {
 public:
  // Uploads what changed. Returns the bytes uploaded. Positions that are not finite are refused: the last good ones
  // stay.
  long update(std::span<const HairInput> inputs, const LightInput& light);

  // In the order of the frame's inputs.
  std::span<HairResources> hairs() { return hairs_; }

  // Binds the hair's textures and block for a draw.
  static void bind(HairResources& hair, const HairDraw& draw);

 private:
  // Brings the resources of `id` to place `slot`, making them when they are new.
  HairResources& claim(std::size_t slot, std::uint64_t id);
  long refresh(HairResources& hair, const HairInput& input, bool light_moved);
  long uploadVertices(HairResources& hair, std::span<const float> positions);

  std::vector<HairResources> hairs_;
  std::vector<Eigen::Matrix<float, 3, 2>> gradients_;
  std::vector<float> texels_;
  Float3 to_fill_{}, to_rim_{};
};

}  // namespace render
