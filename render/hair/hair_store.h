// What the GPU keeps of every hair: positions and gradients, layout, scattering table, look. Kept by id, refilled only
// where something changed, freed when a frame no longer shows the hair. Hairs of one style share its layout, hairs of
// one look its scattering table.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/frame_input.h"
#include "render/frame_report.h"
#include "render/gl/gl_object.h"
#include "render/light/sky_visibility.h"
#include "render/strands/hair_layout.h"
#include "render/view_math.h"

namespace render {

// Topology and rest shape on the GPU, with the draw table of all its strands.
struct HairStyle {
  std::uint64_t id = 0, layout_id = 0, layout_revision = 0;  // id: of the hair it was made for
  int strands = 0;
  HairLayout layout;
  std::vector<int> first_strand;  // see dealStrands
  Buffer buffer;
  Texture texture;
  GLsizeiptr bytes = 0;
  bool seen = false;

  int fullTableTexel() const;
};

// Distances of all skin grids of a body. Hairs on bodies with the same grids share them.
struct SkinDistances {
  std::vector<std::uint64_t> ids;
  std::vector<int> first;  // texel of each
  Buffer buffer;
  Texture texture;
  GLsizeiptr bytes = 0;
  bool seen = false;
};

struct HairScattering {
  HairLook look;
  Float3 forward_albedo{}, backward_albedo{};  // see fiber_scattering.h
  Texture table;
  bool seen = false;
};

// How a pass draws a hair: filled into its uniform block before the draw.
struct HairDraw {
  int segments = 1;     // a layer, where the table does not say otherwise
  int shadow_map = -1;  // the hair's own deep opacity map
  // A table of another texture than the style's: its first texel and entries, or -1 for all strands.
  int table_first = -1, table_entries = 0, table_strands = 0;
  float most_segments = 0;  // a layer, over the table's entries; 0: `segments`
  // Strands of a lower rank (0..1) than `fade_from` are drawn, those above `fade_to` are not; each stands for `gain`.
  float fade_from = 2, fade_to = 3, gain = 1;
};

struct HairResources {
  std::uint64_t id = 0;
  std::uint64_t position_revision = ~std::uint64_t{0}, light_revision = 0;  // nothing uploaded yet
  std::uint64_t bounds_revision = ~std::uint64_t{0};
  HairStyle* style = nullptr;
  HairScattering* scattering = nullptr;
  HeadBall head;
  std::vector<SoftLight> soft_light;                   // per vertex
  std::vector<float> texels;                           // as uploaded
  std::vector<Bounds> face_bounds;                     // m, around all strands of a face
  std::vector<float> face_bend;                        // m, how far a face's strands turn away within a layer
  std::vector<float> face_step;                        // m, a face's longest layer
  int soft_light_age = 0;                              // uploads since it was made
  Bounds bounds, around;                               // of the vertices; with room for all strands
  int strands = -1, segments = 0, asked_segments = 0;  // segments: a layer, with those that curls need
  HairLook look;
  std::vector<SkinEllipsoid> body;          // all that stands before fill and rim
  std::vector<SkinEllipsoid> skin;          // near the hair
  std::vector<SkinGrid> skin_grids;         // the same
  SkinDistances* skin_distances = nullptr;  // of all grids of the body, if there are any
  std::vector<std::uint64_t> skin_reached;  // see skin_reach.h
  Buffer skin_buffer;
  Texture skin_texture;
  GLsizeiptr skin_bytes = 0;
  bool seen = false, drawable = false;  // drawable: has faces and finite positions
  std::uint64_t revision = 0;           // counts changes of anything that is drawn of it
  Buffer vertex_buffer, block;
  Texture vertex_texture;
  GLsizeiptr vertex_bytes = 0;
  Texture openness;                    // see sky_visibility.h
  std::array<int, 3> openness_size{};  // of the texture
  Eigen::Matrix4f openness_from_head = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f openness_from_world = Eigen::Matrix4f::Identity();

  // What this frame draws of it; see hair_detail.h.
  bool in_view = true, casts = true;
  float pixels = 1e9f;  // projected diameter
  HairDraw view_draw, shadow_draw;

  const HairLayout& layout() const { return style->layout; }
  int strandCount(const HairDraw& draw) const { return draw.table_first < 0 ? strands : draw.table_strands; }
  int pointsPerStrand(const HairDraw& draw) const;
  int chunksPerStrand(const HairDraw& draw) const;
  long gpuBytes() const;  // its own, without what it shares
};

// Whether a frame needs a hair at all, given where it is.
struct ViewGate {
  const Frustum* frustum = nullptr;                  // null: everything is needed
  Eigen::Vector3f shadow = Eigen::Vector3f::Zero();  // m, how far shadows reach
  bool admits(const Bounds& bounds) const { return frustum == nullptr || frustum->maySeeSwept(bounds, shadow); }
};

class HairStore {
 public:
  // Uploads what changed of the hairs that the frame needs. Returns the bytes uploaded. Positions that are not finite
  // are refused: the last good ones stay.
  long update(std::span<const HairInput> inputs, const LightInput& light, const DrawSkips& skips = {},
              const ViewGate& gate = {});

  // In the order of the frame's inputs.
  std::span<HairResources> hairs() { return hairs_; }

  const DrawSkipCounts& skipCounts() const { return skip_counts_; }
  long gpuBytes() const;

  // Binds the hair's textures and block for a draw; `table` holds the draw's table if it has one of its own.
  static void bind(HairResources& hair, const HairDraw& draw, const Texture* table = nullptr);

 private:
  // Brings the resources of `id` to place `slot`, making them when they are new.
  HairResources& claim(std::size_t slot, std::uint64_t id);
  HairStyle& styleOf(const HairInput& input, int strands, long& uploaded);
  HairScattering& scatteringOf(const HairLook& look, long& uploaded);
  SkinDistances& distancesOf(std::span<const SkinGrid> grids, long& uploaded);
  long refresh(HairResources& hair, const HairInput& input, const DrawSkips& skips);
  long uploadOpenness(HairResources& hair);
  long uploadSkin(HairResources& hair, std::span<const float> positions, const DrawSkips& skips);
  long uploadVertices(HairResources& hair, const HairInput& input, bool renew_light, const DrawSkips& skips);

  std::vector<HairResources> hairs_;
  std::vector<std::unique_ptr<HairStyle>> styles_;
  std::vector<std::unique_ptr<HairScattering>> scatterings_;
  std::vector<std::unique_ptr<SkinDistances>> distances_;
  SkyVisibility sky_visibility_;
  std::vector<Eigen::Matrix<float, 3, 2>> gradients_;
  std::vector<float> texels_;
  Float3 to_fill_{}, to_rim_{};
  std::uint64_t light_revision_ = 1;
  DrawSkipCounts skip_counts_;
};

// How far (m) a strand may leave the hull of the hair mesh sideways by its look. curl_share: of the curls' radius.
float sidewaysReach(const HairLook& look, float curl_share = 1);

}  // namespace render
