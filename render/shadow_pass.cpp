#include "render/shadow_pass.h"

#include <algorithm>
#include <cstring>
#include <numeric>

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

Texture makeArray(GLenum format, int size, int layers, GLenum filter) {
  Texture texture = makeTexture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(texture.id(), 1, format, size, size, layers);
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

// Shadows stand fewer strands, each standing for more hairs, and coarser curves: both blur by far less than a shadow is
// soft.
HairDraw shadowDraw(const HairResources& hair, const LightInput& light, int map) {
  int stride = 1;
  if (light.shadow_strands > 0) stride = std::max((hair.strands + light.shadow_strands - 1) / light.shadow_strands, 1);
  return {stride, (hair.segments + 1) / 2, map};
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

}  // namespace

ShadowPass::ShadowPass(const std::string& shader_dir)
    : depth_geometry_(shader_dir, {{"strand.vert", "strand_shadow.geom", "depth_only.frag"}, {}, {}}),
      depth_pulling_(shader_dir, {{"strand_shadow_pull.vert", "depth_only.frag"}, {}, {}}),
      opacity_geometry_(shader_dir, {{"strand.vert", "strand_shadow.geom", "opacity.frag"}, {}, {}}),
      opacity_pulling_(shader_dir, {{"strand_shadow_pull.vert", "opacity.frag"}, {}, {}}),
      no_attributes_(makeVertexArray()),
      framebuffer_(makeFramebuffer()) {}

void ShadowPass::allocate(int size, int maps) {
  if (size == size_ && maps <= maps_) return;
  size_ = size;
  maps_ = maps;
  opacity_near_ = makeArray(GL_RGBA16F, size, maps, GL_LINEAR);
  opacity_far_ = makeArray(GL_RGBA16F, size, maps, GL_LINEAR);
  hair_depth_ = makeArray(GL_DEPTH_COMPONENT32F, size, maps, GL_LINEAR);
  body_in_hair_depth_ = makeArray(GL_DEPTH_COMPONENT32F, size, maps, GL_LINEAR);
  compareDepth(body_in_hair_depth_);
  body_depth_ = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(body_depth_.id(), 1, GL_DEPTH_COMPONENT32F, bodyMapSize(size), bodyMapSize(size));
  glTextureParameteri(body_depth_.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(body_depth_.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  compareDepth(body_depth_);
  for (Plan& plan : plans_) plan.drawn = 0;
  body_drawn_ = 0;
}

void ShadowPass::plan(const FrameInput& input, std::span<HairResources> hairs, const BodyPass& bodies,
                      shared::FrameBlock& frame) {
  const LightInput& light = input.light;
  const Vector3f to_light = directionOr(light.to_light, Vector3f::UnitY()), eye = asVector(input.camera.eye);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < hairs.size() && light.shadows; ++i) {
    if (hairs[i].drawable && input.view.show_strands) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return (hairs[a].bounds.center() - eye).squaredNorm() < (hairs[b].bounds.center() - eye).squaredNorm();
  });
  order.resize(std::min<std::size_t>(order.size(), kMaxHairShadows));
  // In the order of the hairs, so that a camera that turns does not shuffle maps that could be kept.
  std::sort(order.begin(), order.end());
  const int size = std::clamp(light.shadow_size, 64, 8192);
  allocate(size, std::max<int>(static_cast<int>(order.size()), 1));
  has_bodies_ = !bodies.bounds().empty() && light.shadows;
  body_signature_ = 0;
  if (has_bodies_) {
    body_frustum_ = lightFrustum(bodies.bounds(), to_light, bodyMapSize(size));
    Signature signature;
    signature.add(body_frustum_.clip_from_world);
    signature.add(bodies.poseSignature());
    body_signature_ = signature.value;
  }
  plans_.resize(order.size());
  map_of_hair_.assign(hairs.size(), -1);
  for (std::size_t map = 0; map < order.size(); ++map) {
    const HairResources& hair = hairs[order[map]];
    Plan& plan = plans_[map];
    plan.hair = order[map];
    Bounds bounds = hair.bounds;
    const float margin = 0.01f + 4 * hair.look.offset + hair.look.curl_radius + hair.look.frizz;
    bounds.low.array() -= margin;
    bounds.high.array() += margin;
    plan.frustum = lightFrustum(bounds, to_light, size);
    plan.first_thickness = firstThickness(hair, light);
    map_of_hair_[order[map]] = static_cast<int>(map);
    Signature signature;
    signature.add(plan.frustum.clip_from_world);
    signature.add(plan.first_thickness);
    signature.add(hair.id);
    signature.add(hair.shadow_revision);
    signature.add(body_signature_);
    signature.add(shadowDraw(hair, light, 0));
    signature.add(input.view.strand_path);
    plan.signature = signature.value;
    frame.hair_shadow[map] = asMat4(plan.frustum.clip_from_world);
    frame.hair_shadow_size[map] = {plan.frustum.side, plan.frustum.side, plan.frustum.depth, plan.first_thickness};
  }
  frame.to_key[3] = static_cast<float>(plans_.size());
  frame.forward[3] = light.shadows ? 1.0f : 0.0f;
  frame.opacity = {static_cast<float>(std::clamp(light.opacity_layers, 1, shared::kMaxOpacityLayers)),
                   std::max(light.shadow_strength, 0.0f), static_cast<float>(size), has_bodies_ ? 1.0f : 0.0f};
  frame.body_shadow = asMat4(body_frustum_.clip_from_world);
}

void ShadowPass::drawHairMap(int map, HairResources& hair, const FrameInput& input) {
  const HairDraw draw = shadowDraw(hair, input.light, map);
  const StrandPath path = input.view.strand_path;
  const bool by_geometry = path == StrandPath::kGeometry;
  HairStore::bind(hair, draw);
  glBindVertexArray(no_attributes_.id());
  const GLuint target = framebuffer_.id();

  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, 0, 0, 0);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT1, 0, 0, 0);
  glNamedFramebufferDrawBuffer(target, GL_NONE);
  glNamedFramebufferTextureLayer(target, GL_DEPTH_ATTACHMENT, hair_depth_.id(), 0, map);
  const float far_away = 1;
  glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far_away);
  glEnable(GL_DEPTH_TEST);
  (by_geometry ? depth_geometry_ : depth_pulling_).use();
  issueStrands(hair, draw, path, {GL_LINE_STRIP, 1});

  glNamedFramebufferTextureLayer(target, GL_DEPTH_ATTACHMENT, 0, 0, 0);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, opacity_near_.id(), 0, map);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT1, opacity_far_.id(), 0, map);
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

StrandCount ShadowPass::drawHairMaps(const FrameInput& input, std::span<HairResources> hairs, BodyPass& bodies) {
  StrandCount count;
  for (std::size_t map = 0; map < plans_.size(); ++map) {
    Plan& plan = plans_[map];
    if (plan.drawn == plan.signature) continue;
    HairResources& hair = hairs[plan.hair];
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, size_, size_);
    drawHairMap(static_cast<int>(map), hair, input);
    count.draw_calls += 2;
    if (has_bodies_) {
      const GLuint target = framebuffer_.id();
      glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, 0, 0, 0);
      glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT1, 0, 0, 0);
      glNamedFramebufferDrawBuffer(target, GL_NONE);
      glNamedFramebufferTextureLayer(target, GL_DEPTH_ATTACHMENT, body_in_hair_depth_.id(), 0, static_cast<int>(map));
      const float far_away = 1;
      glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far_away);
      // What stands between the light and the frustum must shade too: clamped onto its near side.
      glEnable(GL_DEPTH_CLAMP);
      bodies.drawDepth(plan.frustum.clip_from_world);
      glDisable(GL_DEPTH_CLAMP);
    }
    plan.drawn = plan.signature;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return count;
}

void ShadowPass::drawBodyMap(const FrameInput&, BodyPass& bodies) {
  if (!has_bodies_ || body_drawn_ == body_signature_) return;
  const GLuint target = framebuffer_.id();
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT0, 0, 0, 0);
  glNamedFramebufferTextureLayer(target, GL_COLOR_ATTACHMENT1, 0, 0, 0);
  glNamedFramebufferDrawBuffer(target, GL_NONE);
  glNamedFramebufferTexture(target, GL_DEPTH_ATTACHMENT, body_depth_.id(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glViewport(0, 0, bodyMapSize(size_), bodyMapSize(size_));
  const float far_away = 1;
  glClearNamedFramebufferfv(target, GL_DEPTH, 0, &far_away);
  glEnable(GL_DEPTH_TEST);
  bodies.drawDepth(body_frustum_.clip_from_world);
  body_drawn_ = body_signature_;
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
  for (Plan& plan : plans_) plan.drawn = 0;
  return message;
}

}  // namespace render
