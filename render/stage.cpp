#include "render/stage.h"

#include <algorithm>
#include <utility>

#include "shaders/shared.h"

namespace render {

using Eigen::Matrix4f;
using Eigen::Vector3f;

Matrix4f viewProjection(const CameraInput& camera, int width, int height) {
  return cameraMatrix(camera, static_cast<float>(width) / static_cast<float>(height));
}

Frustum viewFrustum(const Matrix4f& view_projection, int width, int height) {
  return Frustum(view_projection, 4 / static_cast<float>(std::min(width, height)));
}

Vector3f shadowReach(const LightInput& light) {
  if (!light.shadows) return Vector3f::Zero();
  constexpr float kFarthest = 40, kTallest = 4;  // m
  const Vector3f to_light = directionOr(light.to_light, Vector3f::UnitY());
  const float drop = std::max(to_light.y(), kTallest / kFarthest);
  return -(kTallest / drop) * to_light;
}

Stage::Stage() : frame_block(makeBuffer()) {
  glNamedBufferStorage(frame_block.id(), sizeof(shared::FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
}

bool Stage::update(const FrameInput& input, FrameReport& report) {
  const Frustum frustum =
      viewFrustum(viewProjection(input.camera, input.width, input.height), input.width, input.height);
  const bool all = !input.skips.view || !input.skips.shadow_view;
  const ViewGate gate = all ? ViewGate{} : ViewGate{&frustum, shadowReach(input.light)};
  report.bytes_uploaded += hairs.update(input.hairs, input.light, input.skips, gate) + bodies.update(input.bodies);
  report.skip_counts = hairs.skipCounts();
  bodies.chooseDetail(input.camera, input.height, input.skips.body_detail);
  revisions_.clear();
  for (const HairResources& hair : hairs.hairs())
    revisions_.push_back({hair.id, hair.in_view && hair.drawable ? hair.revision : 0});
  revisions_.push_back({bodies.poseSignature(), bodies.lookSignature()});
  std::swap(revisions_, last_revisions_);
  return revisions_ != last_revisions_;
}

void Stage::beginRadiance() const {
  radiance.bind();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

void Stage::beginScreen() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace render
