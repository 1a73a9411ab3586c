#include "render/renderer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "render/backdrop_pass.h"
#include "render/body_pass.h"
#include "render/debug_pass.h"
#include "render/gpu_timer.h"
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

struct Renderer::Parts {
  std::string shader_dir;
  HairStore hairs;
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

  long uploadWhatChanged(const FrameInput& input) {
    return hairs.update(input.hairs, input.light) + bodies.update(input.bodies);
  }

  // Fits the light to the scene and brings the frame's constants to the GPU.
  Matrix4f planFrame(const FrameInput& input) {
    radiance.prepare(input.width, input.height, std::max(input.view.samples, 1));
    const Matrix4f view_projection =
        cameraMatrix(input.camera, static_cast<float>(input.width) / static_cast<float>(input.height));
    Bounds scene = bodies.bounds();
    for (const HairResources& hair : hairs.hairs()) {
      if (hair.drawable) scene.add(hair.bounds);
    }
    shared::FrameBlock block = frameBlock(input, view_projection, scene, radiance.samples());
    shadows.plan(input, hairs.hairs(), bodies, block);
    glNamedBufferSubData(frame_block.id(), 0, sizeof(block), &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block.id());
    return view_projection;
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
      count += strands.draw(hairs.hairs()[i], shadows.mapOf(i), input.view.strand_path);
    }
    return count;
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
  report.bytes_uploaded = p.uploadWhatChanged(input);
  const Matrix4f view_projection = p.planFrame(input);
  p.timer.mark("upload");
  const StrandCount shadow_count = p.shadows.drawHairMaps(input, p.hairs.hairs(), p.bodies);
  p.timer.mark("hair shadows");
  p.shadows.drawBodyMap(input, p.bodies);
  p.timer.mark("body shadow");
  p.clearRadiance();
  p.shadows.bindMaps();
  report.draw_calls = shadow_count.draw_calls + p.backdrop.draw(input.view.ground);
  if (input.view.show_body) report.draw_calls += p.bodies.draw(view_projection);
  p.timer.mark("body and ground");
  const StrandCount drawn = p.drawStrands(input);
  p.timer.mark("strands");
  report.draw_calls += p.debug.draw(input, report.bytes_uploaded);
  p.timer.mark("debug");
  p.tone_map.draw(p.radiance, framebuffer, input.width, input.height, input.view.exposure);
  p.timer.mark("tone map");
  report.stages = p.timer.finish();
  report.strands_drawn = drawn.strands;
  report.strand_vertices = drawn.vertices;
  report.draw_calls += drawn.draw_calls + 1;
  for (const HairResources& hair : p.hairs.hairs()) report.gpu_bytes_hair += hair.gpuBytes();
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
