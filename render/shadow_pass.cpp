#include "render/shadow_pass.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "render/shadow_grid.h"

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

Texture makeArray(GLenum format, const TextureExtent& extent, GLenum filter) {
  Texture texture = makeTexture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(texture.id(), 1, format, extent.width, extent.height, extent.layers);
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

void compareDepth(const Texture& texture) {
  glTextureParameteri(texture.id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(texture.id(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

// A body is several times as large as its hair.
int bodyMapSize(int hair_map_size) {
  return 2 * hair_map_size;
}

// Thickness of the first deep opacity layer: small enough to resolve the outer hairs, large enough that the growing
// layers together reach through the hair.
float firstThickness(const HairResources& hair, const LightInput& light) {
  if (light.layer_thickness > 0) return light.layer_thickness;
  float sum = 0, thickness = 1;
  for (int layer = 0; layer < std::clamp(light.opacity_layers, 1, shared::kMaxOpacityLayers); ++layer) {
    sum += thickness;
    thickness *= shared::kLayerGrowth;
  }
  return std::max(0.5f * hair.bounds.diagonal() / sum, 1e-4f);
}

// Texels of a tile's side for every pixel of the hair, while there is room. More cost memory, and the picture came no
// nearer to that with whole tiles: the fewer strands in the map weigh more.
constexpr float kTexelsPerPixel = 1.5f;
constexpr float kFewerTexels = 0.84089642f;  // two to the power of -1/4: times as many, a step down
constexpr int kMostStepsDown = 40;
constexpr int kSmallestTile = 32;  // of them make a whole tile's side

// What a hair beyond the first may add to the maps: with its positions and its body it stays below 100 KB.
constexpr long kTexelsPerHair = 2300;

// Rows come and go in eighths of a whole tile, so that textures are seldom made anew, and fill a layer up to four
// whole ones.
int rowsAtATime(int size) {
  return std::max(size / 8, 8);
}
int mostRows(int size) {
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

ShadowPass::ShadowPass(const std::string& shader_dir)
    : depth_geometry_(shader_dir, {{"strand.vert", "strand_shadow.geom", "depth_only.frag"}, {}, {}}),
      depth_pulling_(shader_dir, {{"strand_shadow_pull.vert", "depth_only.frag"}, {}, {}}),
      opacity_geometry_(shader_dir, {{"strand.vert", "strand_shadow.geom", "opacity.frag"}, {}, {}}),
      opacity_pulling_(shader_dir, {{"strand_shadow_pull.vert", "opacity.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()),
      framebuffer_(makeFramebuffer()) {}

void ShadowPass::allocate(const TextureExtent& extent) {
  const bool same_size = extent.width == extent_.width;
  if (same_size && extent.height <= extent_.height && extent.layers <= extent_.layers) return;
  extent_ = extent;
  opacity_near_ = makeArray(GL_RGBA16F, extent, GL_LINEAR);
  opacity_far_ = makeArray(GL_RGBA16F, extent, GL_LINEAR);
  hair_depth_ = makeArray(GL_DEPTH_COMPONENT32F, extent, GL_LINEAR);
  body_in_hair_depth_ = makeArray(GL_DEPTH_COMPONENT32F, extent, GL_LINEAR);
  compareDepth(body_in_hair_depth_);
  drawn_.clear();
  drawn_before_.clear();
  if (same_size) return;
  const int side = bodyMapSize(extent.width);
  body_depth_ = makeArray(GL_DEPTH_COMPONENT32F, {side, side, shared::kMaxBodyShadows}, GL_LINEAR);
  compareDepth(body_depth_);
  bodies_drawn_.fill(0);
}

long ShadowPass::gpuBytes() const {
  const long side = bodyMapSize(extent_.width);
  return extent_.texels() * (8 + 8 + 4 + 4) + 4L * shared::kMaxBodyShadows * side * side;
}

// A tile that the hair has is kept until it is off by more than a little, so that nothing switches to and fro.
int ShadowPass::tileSide(const Plan& plan, float texels) const {
  const int size = extent_.width;
  if (plan.side_before >= tileFor(0.8f * texels, size) && plan.side_before <= tileFor(1.2f * texels, size))
    return plan.side_before;
  return tileFor(texels, size);
}

// Texels a side follow the hairs' pixels, so many for each that the further hairs' memory stays within its bound: no
// hair is drawn finer than others at their cost.
void ShadowPass::chooseTiles(const FrameInput& input, std::span<const HairResources> hairs) {
  const int size = extent_.width;
  const auto place = [&](int steps_down) {
    const float texels_a_pixel = kTexelsPerPixel * std::pow(kFewerTexels, static_cast<float>(steps_down));
    for (Plan& plan : plans_) {
      plan.tile.side = input.skips.shadow_detail ? tileSide(plan, texels_a_pixel * hairs[plan.hair].pixels) : size;
    }
    return placeTiles();
  };
  TextureExtent extent = place(0);
  if (input.skips.shadow_detail) {
    const long further = kTexelsPerHair * std::max<long>(static_cast<long>(plans_.size()) - 1, 0);
    const long most = static_cast<long>(size) * size + further;
    int steps = 0;
    while (extent.texels() > most && steps < kMostStepsDown) extent = place(++steps);
    // Finer by a single step is not worth that every map changes.
    if (steps + 1 == steps_down_) extent = place(++steps);
    steps_down_ = steps;
  }
  allocate(extent);
}

// Largest tiles first, side by side in rows.
TextureExtent ShadowPass::placeTiles() {
  order_.resize(plans_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return plans_[a].tile.side > plans_[b].tile.side; });
  const int size = extent_.width, most_rows = mostRows(size), step = rowsAtATime(size);
  int x = 0, y = 0, row = 0, layer = 0;
  for (const std::size_t map : order_) {
    Tile& tile = plans_[map].tile;
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

std::uint64_t ShadowPass::signatureOf(const Plan& plan, const HairResources& hair, const FrameInput& input,
                                      const BodyPass& bodies) const {
  Signature signature;
  signature.add(plan.frustum.clip_from_world);
  signature.add(plan.tile);
  signature.add(hair.id);
  signature.add(hair.revision);
  signature.add(has_bodies_ ? bodies.poseSignature(input.skips.shadow_view ? &plan.frustum.clip_from_world : nullptr)
                            : 0);
  const HairDraw& draw = hair.shadow_draw;
  signature.add(draw.segments);
  signature.add(draw.table_strands);
  signature.add(draw.most_segments);
  signature.add(draw.fade_to);
  signature.add(input.view.strand_path);
  return signature.value;
}

// One map for all bodies, and where some stand far one more, the first, for those near the camera: theirs would be
// coarse otherwise.
void ShadowPass::planBodyMaps(const FrameInput& input, const BodyPass& bodies) {
  body_maps_ = 0;
  if (!has_bodies_) return;
  const Vector3f to_light = directionOr(input.light.to_light, Vector3f::UnitY());
  const Bounds near = bodies.boundsNear(asVector(input.camera.eye)), all = bodies.bounds();
  const auto add = [&](const Bounds& bounds, bool some) {
    const auto map = static_cast<std::size_t>(body_maps_++);
    body_frusta_[map] = lightFrustum(bounds, to_light, bodyMapSize(extent_.width));
    Signature signature;
    signature.add(body_frusta_[map].clip_from_world);
    signature.add(bodies.poseSignature(some ? &body_frusta_[map].clip_from_world : nullptr));
    body_signatures_[map] = signature.value;
  };
  if (near.low != all.low || near.high != all.high) add(near, true);
  add(all, false);
}

void ShadowPass::plan(const FrameInput& input, std::span<HairResources> hairs, const BodyPass& bodies,
                      shared::FrameBlock& frame) {
  const LightInput& light = input.light;
  const Vector3f to_light = directionOr(light.to_light, Vector3f::UnitY()), eye = asVector(input.camera.eye);
  left_out_ = {};
  std::vector<std::size_t>& order = order_;
  order.clear();
  for (std::size_t i = 0; i < hairs.size() && light.shadows; ++i) {
    if (!hairs[i].drawable || !input.view.show_strands) continue;
    left_out_.shadow_view += {!hairs[i].casts, 1};
    if (hairs[i].casts) order.push_back(i);
  }
  if (order.size() > kMaxHairShadows) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return (hairs[a].bounds.center() - eye).squaredNorm() < (hairs[b].bounds.center() - eye).squaredNorm();
    });
    order.resize(kMaxHairShadows);
    // In the order of the hairs, so that a camera that turns does not shuffle maps that could be kept.
    std::sort(order.begin(), order.end());
  }
  // A power of two, so that tiles divide it.
  int size = 64;
  while (size * 2 <= std::clamp(light.shadow_size, 64, 8192)) size *= 2;
  if (size != extent_.width) allocate({size, size, 1});
  plans_.resize(order.size());
  map_of_hair_.assign(hairs.size(), -1);
  drawn_before_.swap(drawn_);
  drawn_.clear();
  for (std::size_t map = 0; map < order.size(); ++map) {
    const HairResources& hair = hairs[order[map]];
    plans_[map].hair = order[map];
    map_of_hair_[order[map]] = static_cast<int>(map);
    const auto before =
        std::find_if(drawn_before_.begin(), drawn_before_.end(), [&](const Drawn& d) { return d.hair_id == hair.id; });
    plans_[map].side_before = before != drawn_before_.end() ? before->side : 0;
  }
  chooseTiles(input, hairs);
  has_bodies_ = !bodies.bounds().empty() && light.shadows;
  planBodyMaps(input, bodies);
  for (std::size_t map = 0; map < plans_.size(); ++map) {
    Plan& plan = plans_[map];
    const HairResources& hair = hairs[plan.hair];
    Bounds bounds = hair.bounds;
    const float margin = 0.01f + 4 * hair.look.offset + hair.look.curl_radius + hair.look.frizz;
    bounds.low.array() -= margin;
    bounds.high.array() += margin;
    plan.frustum = lightFrustum(bounds, to_light, plan.tile.side);
    plan.signature = signatureOf(plan, hair, input, bodies);
    const float scale = 1 / static_cast<float>(size), down = 1 / static_cast<float>(extent_.height);
    maps_.hair_shadow[map] = asMat4(plan.frustum.clip_from_world);
    maps_.hair_shadow_size[map] = {plan.frustum.side, static_cast<float>(plan.tile.side), plan.frustum.depth,
                                   firstThickness(hair, light)};
    maps_.hair_shadow_tile[map] = {static_cast<float>(plan.tile.x) * scale, static_cast<float>(plan.tile.y) * down,
                                   static_cast<float>(plan.tile.side) * scale, static_cast<float>(plan.tile.layer)};
    // Around the square that the map covers, wherever in its depth.
    maps_.hair_shadow_ball[map] = asVec4(bounds.center(), 0.75f * plan.frustum.side + 0.5f * plan.frustum.depth);
  }
  if (!block_) {
    block_ = makeBuffer();
    glNamedBufferStorage(block_.id(), sizeof(maps_), nullptr, GL_DYNAMIC_STORAGE_BIT);
    grid_block_ = makeBuffer();
    glNamedBufferStorage(grid_block_.id(), sizeof(grid_), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }
  if (!plans_.empty()) {
    fillShadowGrid({maps_.hair_shadow_ball.data(), plans_.size()}, to_light, grid_);
    glNamedBufferSubData(block_.id(), 0, sizeof(maps_), &maps_);
    glNamedBufferSubData(grid_block_.id(), 0, sizeof(grid_), &grid_);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, 3, block_.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, 4, grid_block_.id());
  frame.to_key[3] = static_cast<float>(plans_.size());
  frame.forward[3] = light.shadows ? 1.0f : 0.0f;
  frame.opacity = {static_cast<float>(std::clamp(light.opacity_layers, 1, shared::kMaxOpacityLayers)),
                   std::max(light.shadow_strength, 0.0f),
                   static_cast<float>(extent_.width) / static_cast<float>(extent_.height),
                   static_cast<float>(body_maps_)};
  for (std::size_t map = 0; map < body_frusta_.size(); ++map)
    frame.body_shadow[map] = asMat4(body_frusta_[map].clip_from_world);
}

void ShadowPass::beginDepth(const Texture& depth, int layer) {
  const GLuint target = framebuffer_.id();
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, 0, 0, 0);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT1, 0, 0, 0);
  glNamedFramebufferDrawBuffer(target, GL_NONE);
  glNamedFramebufferTextureLayer(target, GL_DEPTH_ATTACHMENT, depth.id(), 0, layer);
  const float far_away = 1;
  glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far_away);
  glEnable(GL_DEPTH_TEST);
}

void ShadowPass::drawHairMap(int map, HairResources& hair, const FrameInput& input, const Texture& table) {
  HairDraw draw = hair.shadow_draw;
  draw.shadow_map = map;
  const Plan& plan = plans_[static_cast<std::size_t>(map)];
  const StrandPath path = input.view.strand_path;
  const bool by_geometry = path == StrandPath::kGeometry;
  HairStore::bind(hair, draw, &table);
  glBindVertexArray(no_attributes_.id());
  beginDepth(hair_depth_, plan.tile.layer);
  (by_geometry ? depth_geometry_ : depth_pulling_).use();
  issueStrands(hair, draw, path, {GL_LINE_STRIP, 1});

  const GLuint target = framebuffer_.id();
  glNamedFramebufferTextureLayer(target, GL_DEPTH_ATTACHMENT, 0, 0, 0);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, opacity_near_.id(), 0, plan.tile.layer);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT1, opacity_far_.id(), 0, plan.tile.layer);
  const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(target, 2, targets);
  const float nothing[4] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(target, GL_COLOR, 0, nothing);
  glClearNamedFramebufferfv(target, GL_COLOR, 1, nothing);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBindTextureUnit(shared::kUnitHairDepth, hair_depth_.id());
  (by_geometry ? opacity_geometry_ : opacity_pulling_).use();
  issueStrands(hair, draw, path, {GL_LINE_STRIP, 1});
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

StrandCount ShadowPass::drawHairMaps(const FrameInput& input, std::span<HairResources> hairs, BodyPass& bodies,
                                     const Texture& table) {
  StrandCount count;
  glEnable(GL_SCISSOR_TEST);
  for (std::size_t map = 0; map < plans_.size(); ++map) {
    const Plan& plan = plans_[map];
    HairResources& hair = hairs[plan.hair];
    drawn_.push_back({hair.id, plan.signature, plan.tile.side});
    const auto before =
        std::find_if(drawn_before_.begin(), drawn_before_.end(), [&](const Drawn& d) { return d.hair_id == hair.id; });
    const bool kept = input.skips.shadows && before != drawn_before_.end() && before->signature == plan.signature;
    left_out_.shadows += {kept, 1};
    if (kept) continue;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(plan.tile.x, plan.tile.y, plan.tile.side, plan.tile.side);
    glScissor(plan.tile.x, plan.tile.y, plan.tile.side, plan.tile.side);
    drawHairMap(static_cast<int>(map), hair, input, table);
    count.draw_calls += 2;
    if (!has_bodies_) continue;
    beginDepth(body_in_hair_depth_, plan.tile.layer);
    // What stands between the light and the frustum must shade too: clamped onto its near side.
    glEnable(GL_DEPTH_CLAMP);
    bodies.drawDepth(plan.frustum.clip_from_world, input.skips.shadow_view);
    glDisable(GL_DEPTH_CLAMP);
  }
  glDisable(GL_SCISSOR_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return count;
}

void ShadowPass::drawBodyMap(const FrameInput& input, BodyPass& bodies) {
  if (!has_bodies_) return;
  for (std::size_t map = 0; map < static_cast<std::size_t>(body_maps_); ++map) {
    const bool kept = input.skips.shadows && bodies_drawn_[map] == body_signatures_[map];
    left_out_.shadows += {kept, 1};
    if (kept) continue;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, bodyMapSize(extent_.width), bodyMapSize(extent_.width));
    beginDepth(body_depth_, static_cast<GLint>(map));
    // Bodies beside the near ones may stand between these and the light.
    glEnable(GL_DEPTH_CLAMP);
    bodies.drawDepth(body_frusta_[map].clip_from_world, map + 1 < static_cast<std::size_t>(body_maps_));
    glDisable(GL_DEPTH_CLAMP);
    bodies_drawn_[map] = body_signatures_[map];
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void ShadowPass::bindMaps() const {
  glBindTextureUnit(shared::kUnitOpacityNear, opacity_near_.id());
  glBindTextureUnit(shared::kUnitOpacityFar, opacity_far_.id());
  glBindTextureUnit(shared::kUnitHairDepth, hair_depth_.id());
  glBindTextureUnit(shared::kUnitBodyInHairDepth, body_in_hair_depth_.id());
  glBindTextureUnit(shared::kUnitBodyDepth, body_depth_.id());
}

std::string ShadowPass::reload() {
  std::string message;
  for (ShaderProgram* program : {&depth_geometry_, &depth_pulling_, &opacity_geometry_, &opacity_pulling_}) {
    const std::string fault = program->reloadIfChanged();
    if (message.empty()) message = fault;
  }
  drawn_.clear();
  bodies_drawn_.fill(0);
  return message;
}

}  // namespace render
