// The renderer's one door: what a frame shows, as plain values and spans. Spans need to live until renderFrame returns.
//
// Units: metres, radians, linear RGB in [0, 1] unless said. Matrices: column-major float[16], column vectors.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace render {

using Float3 = std::array<float, 3>;
using Mat4 = std::array<float, 16>;

// A bundle as the strand shaders see it: corner columns (number of the column's first vertex) and number of layers.
struct HairFace {
  std::array<int, 4> first_vertex{-1, -1, -1,
                                  -1};  // corner k, layer l is vertex first_vertex[k] + l; [3] = -1: triangle
  int layers = 0;
  float area = 0;        // m^2 of the root face: strands are dealt out in proportion
  bool covered = false;  // under a hat, out of which a stray strand would stick: it has none
};

// How strands vary and look. Lengths in metres.
struct HairLook {
  float strand_radius = 40e-6f;        // m at the root, of a real hair; drawn ones are wider, see below
  float strands_represented = 100000;  // real hairs the drawn strands stand for: shadows carry all of them
  float width_compensation =
      0.6f;                   // drawn radius = strand_radius * (strands_represented / strands)^this; 0: none, 1: all
  float least_pixels = 1.0f;  // strands thinner than this are drawn this wide and fade by coverage
  float taper = 0.5f;         // tip radius over root radius; cut hair is blunt
  float length_variation = 0.16f;   // strands end up to this share of their length early
  float offset = 0.0012f;           // m, random sideways wander that grows along the strand
  float clump = 0.5f;               // 0..1 pull towards the clump's centre strand, opening and closing along the length
  float clump_size = 0.012f;        // m, typical spacing of clumps on the scalp
  float lock = 0.3f, wisp = 0.35f;  // 0..1 pull of clumps into locks, of hairs into wisps: 3.2 and 0.3 clump sizes
  float drift = 0.002f;             // m, how far locks and clumps stray along their length
  float root_spread = 0.0026f;      // m that hairs fan out beside each other on their first centimetres
  float curl_radius = 0.0f, curl_pitch = 0.035f;  // m; m of hair a turn
  float wave_height = 0.0f, wave_length = 0.06f;  // m, from crest to trough and from crest to crest
  float frizz = 0.0007f;                          // m, small-scale noise amplitude
  float flyaways = 0.03f;                         // share of strands that leave their groups
  float flyaway_lift = 0.006f;                    // m that these stand off the hair
  float hairline = 0.018f;                        // m from the hairline over which hair becomes sparse
  float baby_hairs = 0.6f;                        // 0..1 share of short fine hairs at the hairline
  // Colour: melanin (d'Eon et al. 2011 / pbrt's eumelanin and pheomelanin concentrations) or picked reflectance.
  float eumelanin = 1.1f, pheomelanin = 0.35f;
  bool use_color = false;
  Float3 color{0.35f, 0.2f, 0.1f};
  float root_darkening = 0.35f, tint_variation = 0.2f;
  float beta_m = 0.24f, beta_n = 0.3f;  // longitudinal and azimuthal roughness, 0..1
  float eta = 1.55f;
  float cuticle_angle = 0.05f;    // rad, scale tilt that shifts the R and TRT highlights
  float shine_variation = 0.25f;  // rad, tilt of a strand's highlights against the others', at most
  float specular = 1;             // of R and TRT; what they gain, the light that passes through loses
  float diffuse = 1;              // 0..1, share of the light between strands that is kept
  std::uint32_t seed = 1;

  bool operator==(const HairLook&) const = default;
};

// Shares of a look's values at a strand's root, or at a place along strands; a strand has the product of both.
struct LookShare {
  float width = 1, clump = 1, curl = 1;  // of strand_radius, clump, curl_radius
  float roughness = 1;                   // of the highlights' width along the strand (beta_m)
  Float3 color{1, 1, 1};                 // of the light that passes through pigment, linear
  float frizz = 1;                       // of frizz; at the root alone

  bool operator==(const LookShare&) const = default;
};

// Both empty: 1 everywhere.
struct LookShares {
  std::span<const LookShare> roots;  // one a vertex, at most 1, of which those of roots count; linear between them
  std::span<const LookShare> along;  // at least two, evenly from each strand's root to its tip
};

// An ellipsoid of skin: the affine map of the world to the ball of radius one, row by row, 1/m and translation; and, in
// the ball, which way deep points are led out: to where hair comes from. The longer it is, the shallower the points
// that turn to it; 0: all are led straight out.
struct SkinEllipsoid {
  std::array<std::array<float, 4>, 3> to_ball{};
  std::array<float, 3> home{};

  bool operator==(const SkinEllipsoid&) const = default;
};

// Skin that no ellipsoid stands for: signed distances (m, negative inside) at the nodes of a box that lies farther off
// the skin than strands are lifted; trilinear in between.
struct SkinGrid {
  std::uint64_t id = 0;                            // changes with nodes and distances
  std::array<std::array<float, 4>, 3> to_nodes{};  // world to steps from node to node, row by row, 1/m and translation
  std::array<int, 3> nodes{};                      // at least 2 each; x runs fastest
  std::span<const float> distances;

  bool operator==(const SkinGrid& other) const { return id == other.id && to_nodes == other.to_nodes; }
};

struct HairInput {
  std::uint64_t id = 0;                 // stable per hair; GPU resources are kept by it
  std::uint64_t layout_revision = 0;    // changes when faces or vertex count change
  std::uint64_t position_revision = 0;  // changes when positions changed
  std::uint64_t layout_id = 0;          // hairs of one such id and revision share faces and rest shape; 0: its own
  std::span<const HairFace> faces;
  std::span<const float> positions;  // world, 3 floats a vertex, columns contiguous root to tip
  std::span<const float> rest;       // the same at rest, y up; empty: as the positions are when first seen
  int strands = 20000;               // over the whole hair
  int segments_per_layer = 3;        // 1..8
  HairLook look;
  LookShares shares;                     // they go with the layout
  std::span<const SkinEllipsoid> skin;   // strands are lifted out of the nearest 48; all take soft light
  std::span<const SkinGrid> skin_grids;  // and of these; 16 of those near
};

// A skinned body. The mesh is uploaded once per mesh_id, the root cover once per mesh and scalp id; a frame brings
// joint matrices only.
struct BodyInput {
  std::uint64_t id = 0, mesh_id = 0;
  std::span<const float> positions, normals;  // rest pose, 3 floats a vertex
  std::span<const std::uint32_t> triangles;
  std::span<const std::uint16_t> joints;  // 4 a vertex
  std::span<const float> weights;         // 4 a vertex
  std::span<const Mat4> joint_matrices;   // rest model space to world
  std::uint64_t pose_revision = 0;
  Float3 color{0.285f, 0.193f, 0.150f};
  float roughness = 0.55f;
  // Skin among the roots of a hair is shaded and coloured by them.
  std::uint64_t scalp_id = 0;         // stable per root cover; 0: no hair grows on the body
  std::span<const float> root_cover;  // 2 a vertex: 0 bare .. 1 among the roots; m that the skin is drawn lower
  Float3 root_color{};                // share of light that the roots leave what is seen through them; see rootColor
  float scalp_tint = 0;               // 0..1, strength of shade and colour
  std::uint64_t hair_id = 0;          // of the HairInput that shades it from sky, fill and rim; 0: none
  // Brows, lashes and lips are painted where shaders/common/face.glsl has them.
  Float3 face_origin{};          // m, rest pose: the chin's level under the base of the skull
  float face_height = 0;         // m from chin to crown; 0: no face is painted
  float face_paint = 1;          // 0..1, strength
  std::span<const float> cloth;  // 1 a vertex: m from a garment's edge, negative under it; empty: bare
  bool dressed = true;           // whether the garment is worn
  Float3 cloth_color{0.105f, 0.11f, 0.12f};
  // Colours that the mesh brings along, uploaded with it. In place of `color`, if they are sound.
  std::span<const float> material_places;  // 3 a vertex: u to the right and v down, repeated beyond 0..1; which picture
  std::span<const std::vector<std::uint32_t>> materials;  // square pictures of one size: RGBA8, sRGB, top row first
  bool own_materials = true;                              // whether they are shown
};

struct CameraInput {
  Float3 eye{0, 1.6f, 1.2f}, target{0, 1.6f, 0}, up{0, 1, 0};
  float fov_y = 0.6f, near_plane = 0.05f, far_plane = 60.0f;
  // Half widths and half heights of the picture that the target lies right of and above its middle, by an off-centre
  // projection.
  float shift = 0, rise = 0;

  bool operator==(const CameraInput&) const = default;
};

struct LightInput {
  Float3 to_light{0.45f, 0.8f, 0.6f};  // key light's direction, towards the light
  Float3 key{3.5f, 3.3f, 3.0f}, fill{0.28f, 0.32f, 0.40f}, rim{0.82f, 0.78f, 0.74f};
  Float3 to_fill{-0.55f, 0.25f, 0.8f}, to_rim{-0.6f, 0.3f, -0.85f};
  Float3 ambient_sky{0.22f, 0.24f, 0.28f}, ambient_ground{0.11f, 0.10f, 0.09f};
  int shadow_size = 1024;        // most texels a side of a hair's deep opacity map; the bodies': twice that, to 1024
  int shadow_strands = 8000;     // at most this many strands a hair cast shadow, standing for all; 0: all
  int opacity_layers = 7;        // deep opacity map layers, 1..7 (the eighth channel takes all behind)
  float layer_thickness = 0.0f;  // m of the first layer; 0: derived from the hair's extent
  float shadow_strength = 1.0f;  // scales opacity
  float shadow_strands_per_pixel =
      17.0f;                      // of the hair's projected diameter: strands that cast shadow when it is small
  float shadow_strand_share = 1;  // of those, this share casts shadow, each standing for more hairs
  bool shadows = true;

  bool operator==(const LightInput&) const = default;
};

struct LineVertex {
  Float3 position;
  std::array<float, 4> color;
};  // debug; colour with alpha, not premultiplied

// What grows the strands: the geometry stage, compute shaders (see grown_strands.h), or these with a rasterizer on the
// CPU (see software_strands.h). kAuto: what suits the driver (see driver.h). The pictures agree.
enum class StrandPath { kGeometry, kCompute, kSoftware, kAuto };

struct ViewOptions {
  int samples = 4;  // multisampling, clamped to what the context has
  float exposure = 1.25f;
  Float3 backdrop_top{0.022f, 0.024f, 0.029f}, backdrop_bottom{0.085f, 0.084f, 0.086f},
      ground_color{0.085f, 0.084f, 0.086f};
  float ground_height = 0;  // m
  bool ground = true, show_strands = true, show_body = true;
  StrandPath strand_path = StrandPath::kAuto;
  float strands_per_pixel = 28.0f;  // of the hair's projected diameter: strands drawn when it is small
  float strand_share = 1;           // of those, this share is drawn: the others fade, and these grow wider
  float segment_error = 0.8f;       // pixels that a straight segment may leave its curve by

  bool operator==(const ViewOptions&) const = default;
};

// Work that is left out where the picture does not need it. The first group changes no bit of the picture.
struct DrawSkips {
  bool frame = true;           // a frame equal to the last one is not drawn again
  bool rows = true;            // only the rows of positions that changed are uploaded
  bool shadows = true;         // shadow maps that still show what they should are kept
  bool view = true;            // hairs, bundles and bodies outside the camera's view are not drawn
  bool shadow_view = true;     // no shadow map for hair whose shadow cannot fall into the view
  bool body_parts = true;      // parts of a body outside the view are not skinned
  bool body_detail = true;     // fewer triangles of bodies that are small in the picture
  bool strands = true;         // strand count and width follow the projected size
  bool segments = true;        // segments follow curvature and projected size
  bool shadow_detail = true;   // shadow strands and map size follow the projected size
  bool skin = true;            // strands are held only against skin that they can meet
  bool shading = true;         // in software, only points of strands that some sample shows are shaded
  bool hair_light = true;      // hair's shadow on fine bodies is looked up at their vertices
  bool sky_visibility = true;  // soft light inside far hair is renewed now and then

  bool operator==(const DrawSkips&) const = default;
};

struct FrameInput {
  int width = 1280, height = 720;
  CameraInput camera;
  LightInput light;
  ViewOptions view;
  DrawSkips skips;
  std::span<const HairInput> hairs;
  std::span<const BodyInput> bodies;
  std::span<const LineVertex> debug_lines;      // pairs
  std::span<const LineVertex> debug_triangles;  // triples, blended
  std::span<const LineVertex> debug_points;
};

}  // namespace render
