// What the passes of a frame share: hairs and bodies as the GPU has them, and what earlier passes made for later ones.
//
// A frame may be kept only if the stage's revisions stay and every pass's Input stays (see pass.h). So a pass may read
// anything here: hairs and bodies are covered by the revisions, all else is made by passes from their own Inputs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "render/body/body_store.h"
#include "render/frame_input.h"
#include "render/frame_report.h"
#include "render/gl/render_target.h"
#include "render/hair/hair_detail.h"
#include "render/hair/hair_store.h"
#include "render/shadow_maps.h"

namespace render {

struct Stage {
  HairStore hairs;
  BodyStore bodies;

  // Made by the plan pass.
  HairDetail detail;
  Eigen::Matrix4f view_projection = Eigen::Matrix4f::Identity();
  Buffer frame_block;  // bound as FrameBlock of shaders/shared.h
  RadianceTarget radiance;
  // Planned by the plan pass, drawn by the shadow passes.
  ShadowMaps shadows;

  // Where the screen passes draw.
  unsigned framebuffer = 0;
  int width = 0, height = 0;

  Stage();

  // Uploads what changed of the frame's hairs and bodies. Returns whether anything of them differs from the last frame.
  bool update(const FrameInput& input, FrameReport& report);

  // Sets the state that a pass into the radiance starts from: its framebuffer, depth test and writing, no blending.
  void beginRadiance() const;
  // The same for a pass onto the screen: its framebuffer, no depth test, no blending.
  void beginScreen() const;

 private:
  // Identity and revision of each hair, 0 of those out of reach; then the bodies' signatures.
  std::vector<std::array<std::uint64_t, 2>> revisions_, last_revisions_;
};

// World to clip of the frame's camera.
Eigen::Matrix4f viewProjection(const CameraInput& camera, int width, int height);
// Where strands may be seen: wider by two pixels, as they are drawn at least a pixel wide.
Frustum viewFrustum(const Eigen::Matrix4f& view_projection, int width, int height);
// How far shadows of hair can fall: down to the ground or the lowest body, along the light; zero without shadows.
Eigen::Vector3f shadowReach(const LightInput& light);

}  // namespace render
