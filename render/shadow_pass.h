// Shadow maps of the key light: a deep opacity map for each of the nearest hairs, with the bodies' depth in the same
// view, and one depth map of all bodies. Redrawn only when the light, the hair or a body changed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/body_pass.h"
#include "render/frame_input.h"
#include "render/hair_store.h"
#include "render/shader.h"
#include "render/strand_pass.h"
#include "render/view_math.h"
#include "shaders/shared.h"

namespace render {

class ShadowPass {
 public:
  explicit ShadowPass(const std::string& shader_dir);

  // Chooses the hairs that own a map and fits the light's frusta around hairs and bodies. Writes them into the frame
  // block.
  void plan(const FrameInput& input, std::span<HairResources> hairs, const BodyPass& bodies, shared::FrameBlock& frame);

  // Draws the maps that are out of date. The frame block must be uploaded and bound. Leaves no framebuffer bound.
  StrandCount drawHairMaps(const FrameInput& input, std::span<HairResources> hairs, BodyPass& bodies);
  void drawBodyMap(const FrameInput& input, BodyPass& bodies);

  // Binds every map for the passes that read them.
  void bindMaps() const;

  // The map of hairs[i], or -1.
  int mapOf(std::size_t hair) const { return hair < map_of_hair_.size() ? map_of_hair_[hair] : -1; }

  std::string reload();

 private:
  struct Plan {
    std::size_t hair = 0;
    LightFrustum frustum;
    float first_thickness = 0;
    std::uint64_t signature = 0, drawn = 0;  // of all that the map shows; drawn: what it shows now
  };

  void allocate(int size, int maps);
  void drawHairMap(int map, HairResources& hair, const FrameInput& input);

  ShaderProgram depth_geometry_, depth_pulling_, opacity_geometry_, opacity_pulling_;
  VertexArray no_attributes_;
  Framebuffer framebuffer_;
  Texture opacity_near_, opacity_far_, hair_depth_, body_in_hair_depth_, body_depth_;
  int size_ = 0, maps_ = 0;
  std::vector<Plan> plans_;
  std::vector<int> map_of_hair_;
  LightFrustum body_frustum_;
  std::uint64_t body_signature_ = 0, body_drawn_ = 0;
  bool has_bodies_ = false;
};

}  // namespace render
