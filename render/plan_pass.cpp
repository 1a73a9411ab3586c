// Plans the frame: strands and their detail, shadow maps, and the constants that every shader reads (FrameBlock).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "render/pass.h"
#include "render/plan_input.h"
#include "render/stage.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

// The camera's and the lights' part of the frame block; the shadow pass adds its own.
shared::FrameBlock frameBlock(const PlanInput& input, const Matrix4f& view_projection, const Bounds& scene,
                              int samples) {
  const CameraInput& camera = input.camera;
  const LightInput& light = input.light;
  const auto width = static_cast<float>(input.width), height = static_cast<float>(input.height);
  shared::FrameBlock block{};
  block.view_projection = asMat4(view_projection);
  block.inverse_view_projection = asMat4(view_projection.inverse());
  block.eye = asVec4(camera.eye, 2 * std::tan(0.5f * camera.fov_y) / height);
  const Vector3f ahead = asVector(camera.target) - asVector(camera.eye);
  block.forward = asVec4(ahead.norm() > 1e-9f ? ahead.normalized().eval() : -Vector3f::UnitZ());
  block.viewport = {width, height, 1 / width, 1 / height};
  block.to_key = asVec4(directionOr(light.to_light, Vector3f::UnitY()));
  block.key = asVec4(light.key);
  block.to_fill = asVec4(directionOr(light.to_fill, Vector3f::UnitX()));
  block.fill = asVec4(light.fill);
  block.to_rim = asVec4(directionOr(light.to_rim, -Vector3f::UnitZ()));
  block.rim = asVec4(light.rim);
  block.sky = asVec4(light.ambient_sky, static_cast<float>(samples));
  block.ground_light = asVec4(light.ambient_ground);
  block.backdrop_top = asVec4(input.backdrop_top);
  block.backdrop_bottom = asVec4(input.backdrop_bottom);
  block.ground_color = asVec4(input.ground_color, input.ground_height);
  const Vector3f center = scene.empty() ? asVector(camera.target) : scene.center();
  const float reach = scene.empty() ? 4.0f : 3.0f + scene.diagonal();
  block.ground_center = asVec4(center, reach);
  return block;
}

}  // namespace

class PlanPass {
 public:
  static constexpr const char* kName = "plan";
  static constexpr Target kTarget = Target::kRadiance;
  using Input = PlanInput;
  static Input inputOf(const FrameInput& frame);

  explicit PlanPass(const std::string&) {}
  void draw(const Input& input, Stage& stage, FrameReport& report);
  ReloadReport reload(Reload) { return {}; }
};

PlanPass::Input PlanPass::inputOf(const FrameInput& frame) {
  const ViewOptions& view = frame.view;
  Input input;
  input.width = frame.width;
  input.height = frame.height;
  input.samples = std::max(view.samples, 1);
  input.camera = frame.camera;
  input.light = frame.light;
  input.skips = frame.skips;
  input.backdrop_top = view.backdrop_top;
  input.backdrop_bottom = view.backdrop_bottom;
  input.ground_color = view.ground_color;
  input.ground_height = view.ground_height;
  input.show_strands = view.show_strands;
  input.strand_path = view.strand_path;
  input.strands_per_pixel = view.strands_per_pixel;
  input.strand_share = view.strand_share;
  input.segment_error = view.segment_error;
  return input;
}

void PlanPass::draw(const Input& input, Stage& stage, FrameReport& report) {
  stage.view_projection = viewProjection(input.camera, input.width, input.height);
  const Frustum frustum = viewFrustum(stage.view_projection, input.width, input.height);
  report.bytes_uploaded +=
      stage.detail.plan(input, {&frustum, shadowReach(input.light)}, stage.hairs.hairs(), report.skip_counts);
  stage.radiance.prepare(input.width, input.height, input.samples);
  Bounds scene = stage.bodies.bounds();
  for (const HairResources& hair : stage.hairs.hairs()) {
    if (!hair.bounds.empty()) scene.add(hair.bounds);
  }
  shared::FrameBlock block = frameBlock(input, stage.view_projection, scene, stage.radiance.samples());
  stage.shadows.plan(input, stage.hairs.hairs(), stage.bodies, block, report.skip_counts);
  glNamedBufferSubData(stage.frame_block.id(), 0, sizeof(block), &block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, stage.frame_block.id());
}

template PassEntry makePass<PlanPass>(const std::string& shader_dir);

}  // namespace render
