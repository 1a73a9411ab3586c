// Shadow maps of the key light: a deep opacity map for each hair, with the bodies' depth in the same view, and one
// depth map of all bodies, or two where some stand far. Redrawn only when the light, the hair or a body changed.
//
// The hairs' maps are tiles of one array of textures: a near hair has a whole tile, a far one a part of its side, down
// to a thirty-second; smaller ones too where many hairs share what a crowd may take.
#pragma once

#include <array>
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

// Texels of an array of textures.
struct TextureExtent {
  int width = 0, height = 0, layers = 0;
  long texels() const { return static_cast<long>(width) * height * layers; }
};

class ShadowPass {
 public:
  explicit ShadowPass(const std::string& shader_dir);

  // Chooses the hairs that own a map and fits the light's frusta around hairs and bodies. Writes them into the frame
  // block.
  void plan(const FrameInput& input, std::span<HairResources> hairs, const BodyPass& bodies, shared::FrameBlock& frame);

  // Draws the maps that are out of date. The frame block must be uploaded and bound. Leaves no framebuffer bound.
  // table: of the frame's detail.
  StrandCount drawHairMaps(const FrameInput& input, std::span<HairResources> hairs, BodyPass& bodies,
                           const Texture& table);
  void drawBodyMap(const FrameInput& input, BodyPass& bodies);

  // Binds every map for the passes that read them.
  void bindMaps() const;

  const DrawLeftOut& leftOut() const { return left_out_; }
  long gpuBytes() const;

  // The map of hairs[i], or -1.
  int mapOf(std::size_t hair) const { return hair < map_of_hair_.size() ? map_of_hair_[hair] : -1; }

  std::string reload();

 private:
  struct Tile {
    int x = 0, y = 0, side = 0, layer = 0;  // texels
  };
  struct Plan {
    std::size_t hair = 0;
    int side_before = 0;  // of the hair's last tile; 0: it had none
    LightFrustum frustum;
    Tile tile;
    std::uint64_t signature = 0;  // of all that the map shows
  };
  // What a tile shows now.
  struct Drawn {
    std::uint64_t hair_id = 0, signature = 0;
    int side = 0;  // of the hair's last tile: sizes change only when they are off by enough
  };

  void allocate(const TextureExtent& extent);
  void chooseTiles(const FrameInput& input, std::span<const HairResources> hairs);
  // Gives tiles of known sides their places. Returns what they take.
  TextureExtent placeTiles();
  int tileSide(const Plan& plan, float texels) const;
  void planBodyMaps(const FrameInput& input, const BodyPass& bodies);
  std::uint64_t signatureOf(const Plan& plan, const HairResources& hair, const FrameInput& input,
                            const BodyPass& bodies) const;
  // Lets the framebuffer take depth alone, into a layer of `depth`, and clears what the scissor leaves of it.
  void beginDepth(const Texture& depth, int layer);
  void drawHairMap(int map, HairResources& hair, const FrameInput& input, const Texture& table);

  ShaderProgram depth_geometry_, depth_pulling_, opacity_geometry_, opacity_pulling_;
  VertexArray no_attributes_;
  Framebuffer framebuffer_;
  Texture opacity_near_, opacity_far_, hair_depth_, body_in_hair_depth_, body_depth_;
  Buffer block_, grid_block_;
  TextureExtent extent_;  // of the hairs' maps; a whole tile is as wide
  int steps_down_ = 0;    // from as many texels a pixel as are wanted to those there is room for
  std::vector<Plan> plans_;
  std::vector<Drawn> drawn_, drawn_before_;
  std::vector<std::size_t> order_;
  shared::ShadowBlock maps_{};
  shared::ShadowGridBlock grid_{};
  DrawLeftOut left_out_;
  std::vector<int> map_of_hair_;
  std::array<LightFrustum, shared::kMaxBodyShadows> body_frusta_;
  std::array<std::uint64_t, shared::kMaxBodyShadows> body_signatures_{}, bodies_drawn_{};
  int body_maps_ = 0;
  bool has_bodies_ = false;
};

}  // namespace render
