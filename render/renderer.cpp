#include "render/renderer.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/backdrop_pass.h"
#include "render/body_pass.h"
#include "render/debug_pass.h"
#include "render/gpu_timer.h"
#include "render/hair_detail.h"
#include "render/hair_store.h"
#include "render/render_target.h"
#include "render/shadow_pass.h"
#include "render/strand_pass.h"
#include "render/tone_map.h"
#include "render/view_math.h"
#include "shaders/shared.h"

namespace render {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;

// The camera's and the lights' part of the frame block; the shadow pass adds its own.
shared::FrameBlock frameBlock(const FrameInput& input, const Matrix4f& view_projection, const Bounds& scene,
                              int samples) {
  const CameraInput& camera = input.camera;
  const LightInput& light = input.light;
  const ViewOptions& view = input.view;
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
  block.backdrop_top = asVec4(view.backdrop_top);
  block.backdrop_bottom = asVec4(view.backdrop_bottom);
  block.ground_color = asVec4(view.ground_color, view.ground_height);
  const Vector3f center = scene.empty() ? asVector(camera.target) : scene.center();
  const float reach = scene.empty() ? 4.0f : 3.0f + scene.diagonal();
  block.ground_center = asVec4(center, reach);
  return block;
}

}  // namespace

// All that a picture depends on: while it stays, so does the picture.
struct FrameKey {
  int width = 0, height = 0;
  CameraInput camera;
  LightInput light;
  ViewOptions view;
  DrawSkips skips;
  std::uint64_t body_poses = 0, body_looks = 0;
  std::vector<std::array<std::uint64_t, 2>> hairs;  // id, revision; 0 of hairs that are not in reach

  bool operator==(const FrameKey&) const = default;
};

struct Renderer::Parts {
  std::string shader_dir;
  HairStore hairs;
  HairDetail detail;
  FrameKey key, drawn_key;
  bool has_drawn = false;  // drawn_key says what the radiance shows
  BodyPass bodies;
  ShadowPass shadows;
  StrandPass strands;
  BackdropPass backdrop;
  DebugPass debug;
  ToneMap tone_map;
  RadianceTarget radiance;
  ImageTarget image;
  GpuTimer timer;
  Buffer frame_block;

  explicit Parts(const std::string& dir)
      : shader_dir(dir), bodies(dir), shadows(dir), strands(dir), backdrop(dir), debug(dir), tone_map(dir) {
    frame_block = makeBuffer();
    glNamedBufferStorage(frame_block.id(), sizeof(shared::FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }

  // How far shadows of hair can fall: down to the ground or the lowest body, along the light.
  static Vector3f shadowReach(const FrameInput& input) {
    if (!input.light.shadows) return Vector3f::Zero();
    constexpr float kFarthest = 40, kTallest = 4;  // m
    const Vector3f to_light = directionOr(input.light.to_light, Vector3f::UnitY());
    const float drop = std::max(to_light.y(), kTallest / kFarthest);
    return -(kTallest / drop) * to_light;
  }

  long uploadWhatChanged(const FrameInput& input, const ViewGate& gate) {
    const bool all = !input.skips.view || !input.skips.shadow_view;
    const long uploaded =
        hairs.update(input.hairs, input.light, input.skips, all ? ViewGate{} : gate) + bodies.update(input.bodies);
    bodies.chooseDetail(input);
    return uploaded;
  }

  // Whether the radiance still shows this frame; remembers the frame if not.
  bool isDrawn(const FrameInput& input) {
    key.width = input.width;
    key.height = input.height;
    key.camera = input.camera;
    key.light = input.light;
    key.view = input.view;
    key.skips = input.skips;
    key.body_poses = bodies.poseSignature();
    key.body_looks = bodies.lookSignature();
    key.hairs.clear();
    for (const HairResources& hair : hairs.hairs())
      key.hairs.push_back({hair.id, hair.in_view && hair.drawable ? hair.revision : 0});
    const bool debug_shapes =
        !input.debug_lines.empty() || !input.debug_triangles.empty() || !input.debug_points.empty();
    const bool same = input.skips.frame && has_drawn && !debug_shapes && key == drawn_key;
    has_drawn = !debug_shapes;
    std::swap(key, drawn_key);
    return same;
  }

  // Fits the light to the scene and brings the frame's constants to the GPU.
  void planFrame(const FrameInput& input, const Matrix4f& view_projection) {
    radiance.prepare(input.width, input.height, std::max(input.view.samples, 1));
    Bounds scene = bodies.bounds();
    for (const HairResources& hair : hairs.hairs()) {
      if (!hair.bounds.empty()) scene.add(hair.bounds);
    }
    shared::FrameBlock block = frameBlock(input, view_projection, scene, radiance.samples());
    shadows.plan(input, hairs.hairs(), bodies, block);
    glNamedBufferSubData(frame_block.id(), 0, sizeof(block), &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block.id());
  }

  void clearRadiance() {
    radiance.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
  }

  StrandCount drawStrands(const FrameInput& input) {
    StrandCount count;
    for (std::size_t i = 0; i < hairs.hairs().size() && input.view.show_strands; ++i) {
      count += strands.draw(hairs.hairs()[i], shadows.mapOf(i), input.view.strand_path, detail.table());
    }
    return count;
  }

  void drawRadiance(const FrameInput& input, const ViewGate& gate, const Matrix4f& view_projection,
                    FrameReport& report) {
    report.bytes_uploaded += detail.plan(input, gate, hairs.hairs(), report.left_out);
    planFrame(input, view_projection);
    timer.mark("upload");
    const StrandCount shadow_count = shadows.drawHairMaps(input, hairs.hairs(), bodies, detail.table());
    timer.mark("hair shadows");
    shadows.drawBodyMap(input, bodies);
    timer.mark("body shadow");
    report.left_out.shadows = shadows.leftOut().shadows;
    report.left_out.shadow_view = shadows.leftOut().shadow_view;
    clearRadiance();
    shadows.bindMaps();
    report.draw_calls += shadow_count.draw_calls + backdrop.draw(input.view.ground);
    if (input.view.show_body) report.draw_calls += bodies.draw(view_projection, input.skips, report.left_out);
    timer.mark("body and ground");
    const StrandCount drawn = drawStrands(input);
    timer.mark("strands");
    report.draw_calls += debug.draw(input, report.bytes_uploaded);
    timer.mark("debug");
    report.strands_drawn = drawn.strands;
    report.strand_vertices = drawn.vertices;
    report.draw_calls += drawn.draw_calls;
  }
};

Renderer::Renderer(std::string shader_dir) : parts_(std::make_unique<Parts>(shader_dir)) {}

Renderer::~Renderer() = default;

FrameReport Renderer::renderFrame(const FrameInput& input, unsigned framebuffer, bool measure) {
  Parts& p = *parts_;
  FrameReport report;
  if (input.width <= 0 || input.height <= 0) return report;
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  p.timer.start(measure);
  const Matrix4f view_projection =
      cameraMatrix(input.camera, static_cast<float>(input.width) / static_cast<float>(input.height));
  // Two pixels wider: strands are drawn at least a pixel wide.
  const Frustum frustum(view_projection, 4 / static_cast<float>(std::min(input.width, input.height)));
  const ViewGate gate{&frustum, Parts::shadowReach(input)};
  report.bytes_uploaded = p.uploadWhatChanged(input, gate);
  report.left_out = p.hairs.leftOut();
  const bool kept = p.isDrawn(input);
  report.left_out.frame = {kept, 1};
  if (kept) {
    p.timer.mark("upload");
  } else {
    p.drawRadiance(input, gate, view_projection, report);
  }
  p.tone_map.draw(p.radiance, framebuffer, input.width, input.height, input.view.exposure);
  p.timer.mark("tone map");
  report.stages = p.timer.finish();
  report.draw_calls += 1;
  report.gpu_bytes_hair = p.hairs.gpuBytes();
  report.gpu_bytes_shadows = p.shadows.gpuBytes();
  return report;
}

FrameReport Renderer::renderImage(const FrameInput& input, std::vector<unsigned char>& rgba, bool measure) {
  rgba.clear();
  if (input.width <= 0 || input.height <= 0) return {};
  parts_->image.prepare(input.width, input.height);
  FrameReport report = renderFrame(input, parts_->image.framebuffer(), measure);
  parts_->image.read(rgba);
  return report;
}

std::string Renderer::reloadShaders() {
  std::string message;
  parts_->has_drawn = false;
  for (const std::string& fault : {parts_->bodies.reload(), parts_->shadows.reload(), parts_->strands.reload(),
                                   parts_->backdrop.reload(), parts_->debug.reload(), parts_->tone_map.reload()}) {
    if (message.empty()) message = fault;
  }
  return message;
}

std::string initGl() {
  glewExperimental = GL_TRUE;
  const GLenum status = glewInit();
  if (status != GLEW_OK && status != GLEW_ERROR_NO_GLX_DISPLAY) {
    return std::string("GLEW cannot load OpenGL: ") + reinterpret_cast<const char*>(glewGetErrorString(status));
  }
  if (glCreateTextures == nullptr) return "OpenGL 4.5 functions are missing; a newer driver is needed";
  return {};
}

std::string rendererName() {
  std::string name;
  for (GLenum part : {GL_VENDOR, GL_RENDERER, GL_VERSION}) {
    const GLubyte* text = glGetString(part);
    if (!name.empty()) name += " / ";
    name += text != nullptr ? reinterpret_cast<const char*>(text) : "unknown";
  }
  return name;
}

}  // namespace render
