// Constants and uniform blocks that C++ and GLSL read alike. Only vec4, ivec4 and mat4 members: std140 then equals C
// layout.
#ifdef __cplusplus
#pragma once
#include <array>
namespace render::shared {
using vec4 = std::array<float, 4>;
using ivec4 = std::array<int, 4>;
using mat4 = std::array<float, 16>;
#define SHARED_BLOCK(slot, name) struct alignas(16) name
#define SHARED_ARRAY(type, name, count) std::array<type, count> name
#else
#define SHARED_BLOCK(slot, name) layout(std140, binding = slot) uniform name
#define SHARED_ARRAY(type, name, count) type name[count]
#endif

// A geometry shader invocation emits at most kChunkPoints ribbon points; consecutive chunks of a strand share one
// point. kRibbonComponents: gl_Position, lit colour + coverage, dither. GL 4.5 promises 1,024 components in all; Mesa
// does not enforce it but other drivers do, so strand_pass.cpp checks it at compile time.
const int kChunkPoints = 33;
const int kRibbonComponents = 4 + 4 + 1;
const int kLineComponents = 4 + 1;
const int kMaxOutputComponents = 1024;

const int kMaxHairShadows =
    128;                        // hairs (the nearest ones) that own a deep opacity map; a block of 16 KB holds so many
const int kMaxBodyShadows = 2;  // of the bodies near the camera, and of all
const int kMaxOpacityLayers = 7;      // the eighth channel takes everything
const int kOpacityLevels = 6;         // of the far layers' texture, each half as fine as the one before it
const int kOpacitySums = 8;           // of them and of what lies behind them all
const float kOpacitySteps = 16384.0;  // a line's opacity is rounded to one of so many between 0 and 1
const float kMaxLineOpacity = 64.0;   // nothing is darker
const float kLayerGrowth = 1.5;       // each deep opacity layer is this much thicker than the one before it

// Texels of the two float buffer textures of a hair.
const int kVertexTexels = 3;  // position + sky visibility, du + depths along fill, dv + depths along rim
// Two optical depths in one float: the one towards the light in steps of 1 / kDepthSteps before the point, the one away
// from it as a share of kDeepest behind it.
const float kDepthSteps = 128.0;
const float kDeepest = 32.0;
// Share of the soft light's depths (fill, rim, sky) that lies in front of what the eye sees: their cells are coarser
// than the hair's surface. Fitted to the path tracer, at any number of strands (docs/picture.md).
const float kSoftDepth = 0.7;
// Where bundles fan out, the groups of hairs close by no more than this of what lies between their roots; m per m of
// scalp.
const float kMaxSpread = 1.5;
const float kBackReach = 0.012;  // m: light comes back from hair as far behind a strand
const int kFaceTexels = 3;       // first vertices; columns; layers (negative: covered), first strand, end strand, edge
const int kTableTexels = 1;      // end strand, face, segments a layer (0: the hair's), first strand
const int kColumnTexels = 4;     // rest position + last layer of the shortest bundle around, rest axes u and v, each
                                 // with the part of the way to bare skin along it; way of hair (m a layer, m a layer^2)
                                 // and distance to the hairline (m)
const int kShareTexels = 2;      // shares of width, clump, curl and roughness; of colour; of frizz
// Sizes of a lock and of a wisp over that of a clump.
const float kLockSize = 3.2;
const float kWispSize = 0.3;
const float kFanReach = 0.015;  // m of hair, to where hairs that fan out at the roots are farthest apart

// Texture units.
const int kUnitVertices = 0;
const int kUnitLayout = 1;
const int kUnitScattering = 2;
const int kUnitOpacityNear = 3;
const int kUnitOpacityFar = 4;
const int kUnitHairDepth = 5;
const int kUnitBodyInHairDepth = 6;
const int kUnitBodyDepth = 7;
const int kUnitJoints = 8;
const int kUnitColor = 9;
const int kUnitTable = 10;
const int kUnitSkin = 11;
const int kUnitMaterials = 12;
const int kUnitOpenness = 14;
const int kUnitSkinGrids = 15;
const int kUnitBodyDepthPlain = 13;  // the same as kUnitBodyDepth, read and not compared

// Image units of the deep opacity layers (opacity_layers.comp).
const int kImageSums = 0;
const int kImageNear = 1;
const int kImageFar = 2;
const int kTileGroup = 8;  // invocations of a group, a side

// Strands' points between compute shaders and what draws them (render/grown/grown_strands.h,
// render/software/software_strands.h, render/software/software_shadow.h).
const int kStrandGroup = 32;  // invocations of a group
const int kPointTexels = 3;   // position, share of the strand's length; tangent, sky visibility; depths along fill and
                              // rim, before the point and behind it
const int kSlotRibbons = 0;   // two texels a point, see strand_raster.h; or one: half the ribbon's width, coverage
const int kSlotStrands = 1;
const int kSlotPoints = 2;
const int kSlotSeen = 3;  // numbers of the points that are shaded
const int kSlotColors = 4;
const int kSlotSamples = 5;  // see strand_raster.h

// Strands out of the skin (shaders/common/skin.glsl).
const int kMaxSkin = 48;          // ellipsoids of a hair
const int kMaxSkinGrids = 16;     // and grids: of both together a bit each in 64
const float kSkinSlack = 0.006;   // m of lift within which the skin that a strand can meet stays the same
const float kSkinLeft = 0.0001;   // m, that a point may be left in a grid by
const float kSkinGap = 0.0018;    // m, off an ellipsoid: skin may stick out by so much and counts as covered
const float kSkinBlend = 0.0015;  // m, on either side of that: there the lift sets in
const float kSkinFar =
    4.0;  // squared distance from the middle, in the ellipsoid's own measure: nothing beyond is lifted
const float kSkinMiddle = 0.02;  // the same, from where the way out turns about: nothing nearer is by itself
const float kSkinWhole = 0.15;   // the same: all farther off are lifted whole
const float kSkinBack = 0.005;   // m, of a lift: a strand lifted by more keeps to that side
const float kSkinReturn = 0.15;  // m of hair over which a strand returns from where it was lifted: to a share of 1/e
const int kSkinRounds = 8;       // ellipsoids that meet push a point to and fro
const int kSkinTurns = 4;        // of these rounds; after them all push along one line

// Scattering table (fiber_scattering.h). Slices 0 to 2: N_p of R, TT, TRT: kScatterPhi angles over [0, pi],
// kScatterTheta cosines over [0, 1]. Slice 3: first row: norms of the lobes over kScatterPhi inclinations in [-pi/2,
// pi/2]; last row: what the eye's inclination adds to them. Slice 4: light of several fibres, kVolumeSteps depths in
// front by as many behind, three blocks side by side for the powers 0, 1, 2 of the azimuth's cosine.
const int kScatterPhi = 48;
const int kScatterTheta = 16;
const int kScatterSlices = 5;
const int kVolumeSteps = 16;  // step i: optical depth kVolumeDepth i / (kVolumeSteps - i)
const float kVolumeDepth = 2.0;
const float kGrazing = 0.6;        // see longitudinal_lobes.h
const float kVolumeSpread = 0.55;  // rad: deviation over the half angle of light that several fibres scattered

SHARED_BLOCK(0, FrameBlock) {
  mat4 view_projection;
  mat4 inverse_view_projection;
  vec4 eye;       // world; w: metres a pixel spans at distance 1 m
  vec4 forward;   // unit; w: 1 when the key light casts shadows
  vec4 viewport;  // width, height, 1 / width, 1 / height
  vec4 to_key;    // unit, towards the light; w: number of hair shadow maps
  vec4 key;
  vec4 to_fill;
  vec4 fill;
  vec4 to_rim;
  vec4 rim;
  vec4 sky;  // w: samples of a pixel
  vec4 ground_light;
  vec4 backdrop_top;
  vec4 backdrop_bottom;
  vec4 ground_color;   // w: height of the ground, m
  vec4 ground_center;  // xyz; w: radius at which it has faded away, m
  vec4 opacity;        // layers, strength, width over height of hair maps, number of the bodies' maps
  SHARED_ARRAY(mat4, body_shadow, kMaxBodyShadows);  // world to clip of the bodies' shadow maps, the near bodies' first
};

// The hairs' deep opacity maps: tiles of an array of textures.
SHARED_BLOCK(3, ShadowBlock) {
  SHARED_ARRAY(mat4, hair_shadow, kMaxHairShadows);  // world to clip
  SHARED_ARRAY(vec4, hair_shadow_size,
               kMaxHairShadows);  // m: side, texels a side, depth range, first layer's thickness
  SHARED_ARRAY(vec4, hair_shadow_tile, kMaxHairShadows);  // in the texture: left, bottom, width; its layer
  SHARED_ARRAY(vec4, hair_shadow_ball, kMaxHairShadows);  // world: a ball around the hair; w: its radius, m
};

// Cells across the light, each with a bit for every hair shadow map whose ball reaches into it.
const int kShadowGrid = 28;  // cells a side: a block of 16 KB holds so many
SHARED_BLOCK(4, ShadowGridBlock) {
  vec4 shadow_grid_x;  // xyz: world to cells along the grid's row; w: of the world's origin
  vec4 shadow_grid_y;
  SHARED_ARRAY(ivec4, shadow_grid, kShadowGrid * kShadowGrid);
};

SHARED_BLOCK(1, HairBlock) {
  ivec4 counts;    // faces, entries of the draw table, its first texel, seed
  ivec4 draw;      // strands, chunks a strand, points a strand, own shadow map or -1
  vec4 detail;     // strands of a rank below x are drawn, above y are not; width gain; segments a layer
  vec4 width;      // drawn radius at the root (m), tip over root, projected diameter of the hairs one strand stands for
                   // (m), least width (pixels)
  vec4 shape;      // length variation, offset (m), curl radius (m), curl pitch (m a turn)
  vec4 clumping;   // clump, clump size (m), frizz (m), share of flyaways
  vec4 groups;     // lock, wisp, drift of locks and clumps (m), lift of flyaways (m)
  vec4 waves;      // wave height (m), wave length (m), width of the hairline (m), share of fine hairs there
  vec4 variation;  // spread of the roots (m), tilt of a strand's highlights at most (rad), m that curls, waves
                   // and frizz take a strand from its guide by at most
  vec4 lobe_width;       // standard deviations (rad) of R, TT, TRT over the half angle; w: cuticle angle
  vec4 gain;             // share of the real hairs' width that is drawn, diffuse, root darkening, tint variation
  vec4 forward_albedo;   // mean forward scattering attenuation a_f (Zinke et al. 2008)
  vec4 backward_albedo;  // mean backward scattering attenuation a_b
  vec4 center;           // world: the middle of the head under the hair; w: largest share of width along strands
  vec4 ball;             // world: a ball around the whole hair; w: its radius, m
  ivec4 shares;          // painted shares of the look: first texel of the columns', 0: none; first texel and number of
                         // those along strands
  ivec4 skin_count;      // ellipsoids and grids that strands are lifted out of; steps from layer to layer of a face
  // Four each: world to the ball of radius one; home, liftsWithin(). See skin.glsl.
  SHARED_ARRAY(vec4, skin_rows, 4 * kMaxSkin);
  SHARED_ARRAY(vec4, skin_grid_rows, 3 * kMaxSkinGrids);  // three each: world to steps from node to node
  SHARED_ARRAY(ivec4, skin_grid_nodes, kMaxSkinGrids);    // their numbers; w: the first one's texel
};

SHARED_BLOCK(2, BodyBlock) {
  vec4 body_color;   // linear; w: roughness
  vec4 root_color;   // share of light that hair roots leave the skin between them; w: strength of their tint and shade
  vec4 face;         // rest pose, m: origin of the head units of face.glsl; w: head units a metre
  vec4 cloth_color;  // linear; w: 1 where the garment is worn
  vec4 paint;        // x: strength of the face's paint, 0..1
};

#ifdef __cplusplus
}  // namespace render::shared
#undef SHARED_BLOCK
#undef SHARED_ARRAY
#endif
