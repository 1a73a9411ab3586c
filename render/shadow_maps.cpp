#include "render/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "render/light/shadow_grid.h"

namespace render {
namespace {

using Eigen::Vector3f;
using shared::kMaxHairShadows;

// FNV-1a over plain values: equal signatures mean that a map still shows what it should.
struct Signature {
  std::uint64_t value = 14695981039346656037ull;
  template <typename T>
  void add(const T& item) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &item, sizeof(T));
    for (unsigned char byte : bytes) value = (value ^ byte) * 1099511628211ull;
  }
};

Texture makeArray(GLenum format, const TextureExtent& extent, GLenum filter, GLsizei levels = 1) {
  Texture texture = makeTexture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(texture.id(), levels, format, extent.width, extent.height, extent.layers);
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER,
                      static_cast<GLint>(levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : filter));
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

void compareDepth(const Texture& texture) {
  glTextureParameteri(texture.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(texture.id(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

constexpr float kFarAway = 1;  // the depth of no hair and no body

// A body is several times as large as its hair: its map has twice as many texels a side, but no more than this unless
// the hair's map has.
constexpr int kFineBodyMap = 1024;
int bodyMapSize(int hair_map_size) {
  return std::min(2 * hair_map_size, std::max(kFineBodyMap, hair_map_size));
}

// Thickness of the first deep opacity layer: small enough to resolve the outer hairs, large enough that the growing
// layers together reach through the hair. It follows the frustum, which grows in steps: all of the shadow would change
// with every tip that moves the hair's bounds.
float firstThickness(const LightFrustum& frustum, const LightInput& light) {
  if (light.layer_thickness > 0) return light.layer_thickness;
  float sum = 0, thickness = 1;
  for (int layer = 0; layer < std::clamp(light.opacity_layers, 1, shared::kMaxOpacityLayers); ++layer) {
    sum += thickness;
    thickness *= shared::kLayerGrowth;
  }
  return std::max(0.25f * std::hypot(frustum.side, frustum.depth) / sum, 1e-4f);
}

// Texels of a tile's side for every pixel of the hair, while there is room. More cost memory, and the picture came no
// nearer to that with whole tiles: the fewer strands in the map weigh more.
constexpr float kTexelsPerPixel = 1.5f;
constexpr float kFewerTexels = 0.84089642f;  // two to the power of -1/4: times as many, a step down
constexpr int kMaxStepsDown = 40;
constexpr int kSmallestTile = 32;  // of them make a whole tile's side

// What a hair beyond the first may add to the maps: with its positions and its body it stays below 100 KB.
constexpr long kTexelsPerHair = 2300;

// Rows come and go in eighths of a whole tile, so that textures are seldom made anew, and fill a layer up to four
// whole ones.
int rowsAtATime(int size) {
  return std::max(size / 8, 8);
}
int maxRows(int size) {
  return std::max(size, std::min(4 * size, 16384));
}

// Sides of tiles: a whole one's, three quarters, a half, three eighths and so on. The least that has `texels`.
int tileFor(float texels, int size) {
  const int least = std::max(size / kSmallestTile, 8);
  int side = size;
  for (int next = size / 4 * 3; next >= least && static_cast<float>(next) >= texels;) {
    side = next;
    next = side % 3 == 0 ? side / 3 * 2 : side / 4 * 3;
  }
  return side;
}

}  // namespace

ShadowMaps::ShadowMaps() : framebuffer_(makeFramebuffer()), unattached_(makeFramebuffer()), plain_(makeSampler()) {
  glSamplerParameteri(plain_.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glSamplerParameteri(plain_.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glSamplerParameteri(plain_.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(plain_.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(plain_.id(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
}

void ShadowMaps::allocate(const TextureExtent& extent) {
  const bool same_size = extent.width == extent_.width;
  if (same_size && extent.height <= extent_.height && extent.layers <= extent_.layers) return;
  extent_ = extent;
  opacity_near_ = makeArray(GL_RGBA16F, extent, GL_LINEAR);
  opacity_far_ = makeArray(GL_RGBA16F, extent, GL_LINEAR, shared::kOpacityLevels);
  hair_depth_ = makeArray(GL_DEPTH_COMPONENT32F, extent, GL_LINEAR);
  body_in_hair_depth_ = makeArray(GL_DEPTH_COMPONENT32F, extent, GL_LINEAR);
  compareDepth(body_in_hair_depth_);
  // Filters may touch what lies beside a tile, coarse texels reach past it: nothing of it may be left as it was found.
  for (const Texture* opacity : {&opacity_near_, &opacity_far_})
    glClearTexImage(opacity->id(), 0, GL_RGBA, GL_FLOAT, nullptr);
  for (const Texture* depth : {&hair_depth_, &body_in_hair_depth_})
    glClearTexImage(depth->id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, &kFarAway);
  drawn_.clear();
  drawn_before_.clear();
  if (same_size) return;
  const int side = bodyMapSize(extent.width);
  body_depth_ = makeArray(GL_DEPTH_COMPONENT32F, {side, side, shared::kMaxBodyShadows}, GL_LINEAR);
  compareDepth(body_depth_);
  for (BodyMap& map : body_maps_) map.drawn = 0;
}

long ShadowMaps::gpuBytes() const {
  const long side = bodyMapSize(extent_.width);
  return extent_.texels() * (8 + 8 + 4 + 4) + extent_.texels() * 8 / 3 + 4L * shared::kMaxBodyShadows * side * side +
         4L * shared::kOpacitySums * sums_side_ * sums_side_;
}

// A tile that the hair has is kept until it is off by more than a little, so that nothing switches to and fro.
int ShadowMaps::tileSide(const HairMap& map, float texels) const {
  const int size = extent_.width;
  if (map.side_before >= tileFor(0.8f * texels, size) && map.side_before <= tileFor(1.2f * texels, size))
    return map.side_before;
  return tileFor(texels, size);
}

// Texels a side follow the hairs' pixels, so many for each that the further hairs' memory stays within its bound: no
// hair is drawn finer than others at their cost.
void ShadowMaps::chooseTiles(const PlanInput& input, std::span<const HairResources> hairs) {
  const int size = extent_.width;
  const auto place = [&](int steps_down) {
    const float texels_a_pixel = kTexelsPerPixel * std::pow(kFewerTexels, static_cast<float>(steps_down));
    for (HairMap& map : hair_maps_) {
      map.tile.side = input.skips.shadow_detail ? tileSide(map, texels_a_pixel * hairs[map.hair].pixels) : size;
    }
    return placeTiles();
  };
  TextureExtent extent = place(0);
  if (input.skips.shadow_detail) {
    const long further = kTexelsPerHair * std::max<long>(static_cast<long>(hair_maps_.size()) - 1, 0);
    const long most = static_cast<long>(size) * size + further;
    int steps = 0;
    while (extent.texels() > most && steps < kMaxStepsDown) extent = place(++steps);
    // Finer by a single step is not worth that every map changes.
    if (steps + 1 == steps_down_) extent = place(++steps);
    steps_down_ = steps;
  }
  allocate(extent);
}

// Largest tiles first, side by side in rows.
TextureExtent ShadowMaps::placeTiles() {
  order_.resize(hair_maps_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return hair_maps_[a].tile.side > hair_maps_[b].tile.side; });
  const int size = extent_.width, most_rows = maxRows(size), step = rowsAtATime(size);
  int x = 0, y = 0, row = 0, layer = 0;
  for (const std::size_t map : order_) {
    Tile& tile = hair_maps_[map].tile;
    if (x + tile.side > size || row == 0) {
      x = 0;
      y += row;
      row = tile.side;
    }
    if (y + row > most_rows) {
      y = 0;
      ++layer;
    }
    tile.x = x;
    tile.y = y;
    tile.layer = layer;
    x += tile.side;
  }
  const int rows = std::max((y + row + step - 1) / step * step, size);
  return {size, layer > 0 ? most_rows : std::min(rows, most_rows), layer + 1};
}

std::uint64_t ShadowMaps::signatureOf(const HairMap& map, const HairResources& hair, const PlanInput& input,
                                      const BodyStore& bodies) const {
  Signature signature;
  signature.add(map.frustum.clip_from_world);
  signature.add(map.tile);
  signature.add(hair.id);
  signature.add(hair.revision);
  signature.add(has_bodies_ ? bodies.poseSignature(input.skips.shadow_view ? &map.frustum.clip_from_world : nullptr)
                            : 0);
  signature.add(firstThickness(map.frustum, input.light));
  const HairDraw& draw = hair.shadow_draw;
  signature.add(draw.segments);
  signature.add(draw.table_strands);
  signature.add(draw.most_segments);
  signature.add(draw.fade_to);
  signature.add(input.strand_path);
  return signature.value;
}

// One map for all bodies, and where some stand far one more, the first, for those near the camera: theirs would be
// coarse otherwise.
void ShadowMaps::planBodyMaps(const PlanInput& input, const BodyStore& bodies) {
  body_map_count_ = 0;
  has_bodies_ = !bodies.bounds().empty() && input.light.shadows;
  if (!has_bodies_) return;
  const Vector3f to_light = directionOr(input.light.to_light, Vector3f::UnitY());
  const Bounds near = bodies.boundsNear(asVector(input.camera.eye)), all = bodies.bounds();
  const auto add = [&](const Bounds& bounds, bool some) {
    BodyMap& map = body_maps_[static_cast<std::size_t>(body_map_count_++)];
    map.frustum = lightFrustum(bounds, to_light, bodyMapSize(extent_.width));
    map.some = some;
    Signature signature;
    signature.add(map.frustum.clip_from_world);
    signature.add(bodies.poseSignature(some ? &map.frustum.clip_from_world : nullptr));
    map.signature = signature.value;
  };
  if (near.low != all.low || near.high != all.high) add(near, true);
  add(all, false);
}

void ShadowMaps::chooseHairs(const PlanInput& input, std::span<const HairResources> hairs,
                             DrawSkipCounts& skip_counts) {
  const Vector3f eye = asVector(input.camera.eye);
  order_.clear();
  for (std::size_t i = 0; i < hairs.size() && input.light.shadows; ++i) {
    if (!hairs[i].drawable || !input.show_strands) continue;
    skip_counts.shadow_view += {!hairs[i].casts, 1};
    if (hairs[i].casts) order_.push_back(i);
  }
  if (order_.size() <= kMaxHairShadows) return;
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return (hairs[a].bounds.center() - eye).squaredNorm() < (hairs[b].bounds.center() - eye).squaredNorm();
  });
  order_.resize(kMaxHairShadows);
  // In the order of the hairs, so that a camera that turns does not shuffle maps that could be kept.
  std::sort(order_.begin(), order_.end());
}

const ShadowMaps::Drawn* ShadowMaps::drawnBefore(std::uint64_t hair_id) const {
  const auto found =
      std::find_if(drawn_before_.begin(), drawn_before_.end(), [&](const Drawn& d) { return d.hair_id == hair_id; });
  return found != drawn_before_.end() ? &*found : nullptr;
}

void ShadowMaps::startHairMaps(std::span<const HairResources> hairs) {
  drawn_before_.swap(drawn_);
  drawn_.clear();
  hair_maps_.resize(order_.size());
  map_of_hair_.assign(hairs.size(), -1);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    HairMap& map = hair_maps_[i];
    map.hair = order_[i];
    map.hair_id = hairs[map.hair].id;
    map_of_hair_[map.hair] = static_cast<int>(i);
    const Drawn* before = drawnBefore(map.hair_id);
    map.side_before = before != nullptr ? before->side : 0;
  }
}

void ShadowMaps::fitHairMap(std::size_t index, const PlanInput& input, const HairResources& hair,
                            const BodyStore& bodies) {
  HairMap& map = hair_maps_[index];
  Bounds bounds = hair.bounds;
  const float margin = 0.01f + 4 * hair.look.offset + hair.look.curl_radius + hair.look.frizz;
  bounds.low.array() -= margin;
  bounds.high.array() += margin;
  map.frustum = lightFrustum(bounds, directionOr(input.light.to_light, Vector3f::UnitY()), map.tile.side);
  map.signature = signatureOf(map, hair, input, bodies);
  const float scale = 1 / static_cast<float>(extent_.width), down = 1 / static_cast<float>(extent_.height);
  maps_.hair_shadow[index] = asMat4(map.frustum.clip_from_world);
  maps_.hair_shadow_size[index] = {map.frustum.side, static_cast<float>(map.tile.side), map.frustum.depth,
                                   firstThickness(map.frustum, input.light)};
  maps_.hair_shadow_tile[index] = {static_cast<float>(map.tile.x) * scale, static_cast<float>(map.tile.y) * down,
                                   static_cast<float>(map.tile.side) * scale, static_cast<float>(map.tile.layer)};
  // Around the square that the map covers, wherever in its depth.
  maps_.hair_shadow_ball[index] = asVec4(bounds.center(), 0.75f * map.frustum.side + 0.5f * map.frustum.depth);
}

void ShadowMaps::uploadBlocks(const PlanInput& input) {
  if (!block_) {
    block_ = makeBuffer();
    glNamedBufferStorage(block_.id(), sizeof(maps_), nullptr, GL_DYNAMIC_STORAGE_BIT);
    grid_block_ = makeBuffer();
    glNamedBufferStorage(grid_block_.id(), sizeof(grid_), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  if (!hair_maps_.empty()) {
    const Vector3f to_light = directionOr(input.light.to_light, Vector3f::UnitY());
    fillShadowGrid({maps_.hair_shadow_ball.data(), hair_maps_.size()}, to_light, grid_);
    glNamedBufferSubData(block_.id(), 0, sizeof(maps_), &maps_);
    glNamedBufferSubData(grid_block_.id(), 0, sizeof(grid_), &grid_);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, 3, block_.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, 4, grid_block_.id());
}

void ShadowMaps::plan(const PlanInput& input, std::span<HairResources> hairs, const BodyStore& bodies,
                      shared::FrameBlock& frame, DrawSkipCounts& skip_counts) {
  const LightInput& light = input.light;
  chooseHairs(input, hairs, skip_counts);
  // A power of two, so that tiles divide it.
  int size = 64;
  while (size * 2 <= std::clamp(light.shadow_size, 64, 8192)) size *= 2;
  if (size != extent_.width) allocate({size, size, 1});
  startHairMaps(hairs);
  chooseTiles(input, hairs);
  planBodyMaps(input, bodies);
  for (std::size_t map = 0; map < hair_maps_.size(); ++map) fitHairMap(map, input, hairs[hair_maps_[map].hair], bodies);
  uploadBlocks(input);
  frame.to_key[3] = static_cast<float>(hair_maps_.size());
  frame.forward[3] = light.shadows ? 1.0f : 0.0f;
  frame.opacity = {static_cast<float>(std::clamp(light.opacity_layers, 1, shared::kMaxOpacityLayers)),
                   std::max(light.shadow_strength, 0.0f),
                   static_cast<float>(extent_.width) / static_cast<float>(extent_.height),
                   static_cast<float>(body_map_count_)};
  for (std::size_t map = 0; map < body_maps_.size(); ++map)
    frame.body_shadow[map] = asMat4(body_maps_[map].frustum.clip_from_world);
}

bool ShadowMaps::claimHairMap(std::size_t map) {
  const HairMap& wanted = hair_maps_[map];
  const Drawn* before = drawnBefore(wanted.hair_id);
  drawn_.push_back({wanted.hair_id, wanted.signature, wanted.tile.side});
  return before != nullptr && before->signature == wanted.signature;
}

bool ShadowMaps::claimBodyMap(std::size_t map) {
  BodyMap& wanted = body_maps_[map];
  return std::exchange(wanted.drawn, wanted.signature) == wanted.signature;
}

void ShadowMaps::beginDepth(const Texture& depth, int layer) {
  const GLuint target = framebuffer_.id();
  glNamedFramebufferDrawBuffer(target, GL_NONE);
  glNamedFramebufferTextureLayer(target, GL_DEPTH_ATTACHMENT, depth.id(), 0, layer);
  glClearNamedFramebufferfv(target, GL_DEPTH, 0, &kFarAway);
  glEnable(GL_DEPTH_TEST);
}

void ShadowMaps::beginTile(const HairMap& map) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glEnable(GL_SCISSOR_TEST);
  glViewport(map.tile.x, map.tile.y, map.tile.side, map.tile.side);
  glScissor(map.tile.x, map.tile.y, map.tile.side, map.tile.side);
}

void ShadowMaps::beginHairDepth(const HairMap& map) {
  beginTile(map);
  beginDepth(hair_depth_, map.tile.layer);
}

void ShadowMaps::beginOpacity(const HairMap& map) {
  beginTile(map);
  const int side = extent_.width;
  if (sums_side_ != side) {
    sums_side_ = side;
    opacity_sums_ = makeArray(GL_R32UI, {side, side, shared::kOpacitySums}, GL_NEAREST);
  }
  glClearTexSubImage(opacity_sums_.id(), 0, 0, 0, 0, map.tile.side, map.tile.side, shared::kOpacitySums, GL_RED_INTEGER,
                     GL_UNSIGNED_INT, nullptr);
  glNamedFramebufferParameteri(unattached_.id(), GL_FRAMEBUFFER_DEFAULT_WIDTH, extent_.width);
  glNamedFramebufferParameteri(unattached_.id(), GL_FRAMEBUFFER_DEFAULT_HEIGHT, extent_.height);
  glBindFramebuffer(GL_FRAMEBUFFER, unattached_.id());
  glDisable(GL_DEPTH_TEST);
  glBindImageTexture(shared::kImageSums, opacity_sums_.id(), 0, GL_TRUE, 0, GL_READ_WRITE, GL_R32UI);
  glBindTextureUnit(shared::kUnitHairDepth, hair_depth_.id());
}

void ShadowMaps::sumOpacity(const HairMap& map) {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  glBindImageTexture(shared::kImageNear, opacity_near_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  glBindImageTexture(shared::kImageFar, opacity_far_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  const auto groups = static_cast<GLuint>((map.tile.side + shared::kTileGroup - 1) / shared::kTileGroup);
  glDispatchCompute(groups, groups, 1);
  // Read as textures, averaged, and by the next map's image.
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                  GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void ShadowMaps::describeTile(std::size_t map, OpacityTile& tile) const {
  const shared::vec4& size = maps_.hair_shadow_size[map];
  tile.side = hair_maps_[map].tile.side;
  tile.depth_range = size[2];
  tile.thickness = size[3];
}

void ShadowMaps::fillHairMap(std::size_t map, const OpacityTile& filled) {
  const Tile& tile = hair_maps_[map].tile;
  const auto put = [&](const Texture& texture, GLenum format, const void* texels) {
    glTextureSubImage3D(texture.id(), 0, tile.x, tile.y, tile.layer, tile.side, tile.side, 1, format, GL_FLOAT, texels);
  };
  put(hair_depth_, GL_DEPTH_COMPONENT, filled.depth.data());
  put(opacity_near_, GL_RGBA, filled.near.data());
  put(opacity_far_, GL_RGBA, filled.far.data());
}

void ShadowMaps::finishOpacity() {
  glGenerateTextureMipmap(opacity_far_.id());
}

void ShadowMaps::beginBodyInHairDepth(const HairMap& map) {
  beginTile(map);
  beginDepth(body_in_hair_depth_, map.tile.layer);
}

void ShadowMaps::beginBodyDepth(std::size_t map) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glDisable(GL_SCISSOR_TEST);
  glViewport(0, 0, bodyMapSize(extent_.width), bodyMapSize(extent_.width));
  beginDepth(body_depth_, static_cast<GLint>(map));
}

void ShadowMaps::bindMaps() const {
  glBindTextureUnit(shared::kUnitOpacityNear, opacity_near_.id());
  glBindTextureUnit(shared::kUnitOpacityFar, opacity_far_.id());
  glBindTextureUnit(shared::kUnitHairDepth, hair_depth_.id());
  glBindTextureUnit(shared::kUnitBodyInHairDepth, body_in_hair_depth_.id());
  glBindTextureUnit(shared::kUnitBodyDepth, body_depth_.id());
  glBindTextureUnit(shared::kUnitBodyDepthPlain, body_depth_.id());
  glBindSampler(shared::kUnitBodyDepthPlain, plain_.id());
}

void ShadowMaps::forget() {
  drawn_.clear();
  for (BodyMap& map : body_maps_) map.drawn = 0;
}

}  // namespace render
