// Shadow maps of the key light: a deep opacity map for each hair, with the bodies' depth in the same view, and one
// depth map of all bodies, or two where some stand far. Redrawn only when the light, the hair or a body changed.
//
// The hairs' maps are tiles of one array of textures: a near hair has a whole tile, a far one a part of its side, down
// to a thirty-second; smaller ones too where many hairs share what a crowd may take.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "render/body/body_store.h"
#include "render/frame_report.h"
#include "render/hair/hair_store.h"
#include "render/plan_input.h"
#include "render/software/line_raster.h"
#include "render/view_math.h"
#include "shaders/shared.h"

namespace render {

// Texels of an array of textures.
struct TextureExtent {
  int width = 0, height = 0, layers = 0;
  long texels() const { return static_cast<long>(width) * height * layers; }
};

class ShadowMaps {
 public:
  // A tile of the hairs' maps.
  struct Tile {
    int x = 0, y = 0, side = 0, layer = 0;  // texels
  };
  // A hair's own map.
  struct HairMap {
    std::size_t hair = 0;  // place among the frame's hairs
    std::uint64_t hair_id = 0;
    int side_before = 0;  // of the hair's last tile; 0: it had none
    LightFrustum frustum;
    Tile tile;
    std::uint64_t signature = 0;  // of all that the map shows
  };
  // A map of bodies.
  struct BodyMap {
    LightFrustum frustum;
    std::uint64_t signature = 0, drawn = 0;  // of all that the map should show, and of what it shows
    bool some = false;                       // of the bodies near the camera only
  };

  ShadowMaps();

  // Chooses the hairs that own a map and fits the light's frusta around hairs and bodies. Writes them into the frame
  // block. Each hair without a map because its shadow cannot be seen counts as left out.
  void plan(const PlanInput& input, std::span<HairResources> hairs, const BodyStore& bodies, shared::FrameBlock& frame,
            DrawSkipCounts& skip_counts);

  std::span<const HairMap> hairMaps() const { return hair_maps_; }
  std::span<const BodyMap> bodyMaps() const { return {body_maps_.data(), static_cast<std::size_t>(body_map_count_)}; }
  // The map of hairs[i], or -1.
  int mapOf(std::size_t hair) const { return hair < map_of_hair_.size() ? map_of_hair_[hair] : -1; }

  // Whether a map shows already what it should. From then on it counts as drawn: the caller draws it if not.
  bool claimHairMap(std::size_t map);
  bool claimBodyMap(std::size_t map);

  // Binds the framebuffer to a map's texels, cleared, for the next draws: a hair's depth, what opacity.frag adds up
  // (which reads that depth), the bodies' depth in a hair's view, a map of bodies.
  void beginHairDepth(const HairMap& map);
  void beginOpacity(const HairMap& map);
  // Makes opacity layers of what was added up, with opacity_layers.comp in use.
  void sumOpacity(const HairMap& map);
  void beginBodyInHairDepth(const HairMap& map);
  void beginBodyDepth(std::size_t map);

  // What a tile filled on the CPU has to know; and one that is filled, put in its place.
  void describeTile(std::size_t map, OpacityTile& tile) const;
  void fillHairMap(std::size_t map, const OpacityTile& tile);

  // Averages the opacity of all hairs' maps over ever coarser texels, once those that changed are drawn.
  void finishOpacity();

  // Binds every map for the passes that read them.
  void bindMaps() const;

  // Draws all maps again in the next frame.
  void forget();

  long gpuBytes() const;

 private:
  // What a tile shows now.
  struct Drawn {
    std::uint64_t hair_id = 0, signature = 0;
    int side = 0;
  };

  void allocate(const TextureExtent& extent);
  // Fills order_ with the hairs that own a map: those that cast shadow, the nearest if there are too many.
  void chooseHairs(const PlanInput& input, std::span<const HairResources> hairs, DrawSkipCounts& skip_counts);
  void startHairMaps(std::span<const HairResources> hairs);
  void chooseTiles(const PlanInput& input, std::span<const HairResources> hairs);
  // Gives tiles of known sides their places. Returns what they take.
  TextureExtent placeTiles();
  int tileSide(const HairMap& map, float texels) const;
  void fitHairMap(std::size_t map, const PlanInput& input, const HairResources& hair, const BodyStore& bodies);
  void planBodyMaps(const PlanInput& input, const BodyStore& bodies);
  std::uint64_t signatureOf(const HairMap& map, const HairResources& hair, const PlanInput& input,
                            const BodyStore& bodies) const;
  void uploadBlocks(const PlanInput& input);
  const Drawn* drawnBefore(std::uint64_t hair_id) const;
  void beginTile(const HairMap& map);
  // Lets the framebuffer take depth alone, into a layer of `depth`, and clears what the scissor leaves of it.
  void beginDepth(const Texture& depth, int layer);

  Framebuffer framebuffer_, unattached_;  // the second has no texture: what is drawn is added up
  Texture opacity_near_, opacity_far_, hair_depth_, body_in_hair_depth_, body_depth_;
  Texture opacity_sums_;  // of one tile; made where a GPU adds up
  int sums_side_ = 0;     // texels
  Sampler plain_;         // for depth that is read and not compared
  Buffer block_, grid_block_;
  TextureExtent extent_;  // of the hairs' maps; a whole tile is as wide
  int steps_down_ = 0;    // from as many texels a pixel as are wanted to those there is room for
  std::vector<HairMap> hair_maps_;
  std::vector<int> map_of_hair_;
  std::vector<Drawn> drawn_, drawn_before_;
  std::vector<std::size_t> order_;
  shared::ShadowBlock maps_{};
  shared::ShadowGridBlock grid_{};
  std::array<BodyMap, shared::kMaxBodyShadows> body_maps_;
  int body_map_count_ = 0;
  bool has_bodies_ = false;
};

}  // namespace render
