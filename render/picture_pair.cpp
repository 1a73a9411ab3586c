#include "render/picture_pair.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "render/gl/render_target.h"

namespace render {

namespace {

constexpr int kLineWidth = 2;  // pixels

int linePixel(const PairLayout& layout, int width) {
  const double share = layout.side_by_side ? 0.5 : std::clamp(layout.line, 0.0, 1.0);
  return static_cast<int>(std::lround(share * width));
}

void copyColumns(unsigned from, unsigned to, int from_x, int to_x, int width, int height) {
  if (width <= 0) return;
  glBlitNamedFramebuffer(from, to, from_x, 0, from_x + width, height, to_x, 0, to_x + width, height,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void drawLine(unsigned framebuffer, int x, int height) {
  constexpr float kTint[4] = {0.93f, 0.66f, 0.46f, 1};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glEnable(GL_SCISSOR_TEST);
  glScissor(std::max(0, x - kLineWidth / 2), 0, kLineWidth, height);
  glClearBufferfv(GL_COLOR, 0, kTint);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace

int firstWidth(const PairLayout& layout, int width) {
  return layout.side_by_side ? linePixel(layout, width) : width;
}

int secondWidth(const PairLayout& layout, int width) {
  return layout.side_by_side ? width - linePixel(layout, width) : width;
}

struct PicturePair::Impl {
  std::string shader_dir;
  std::optional<Renderer> renderer;  // made when a second picture is first drawn
  ImageTarget first, second, whole;
};

PicturePair::PicturePair(std::string shader_dir) : impl_(std::make_unique<Impl>()) {
  impl_->shader_dir = std::move(shader_dir);
}

PicturePair::~PicturePair() = default;

FrameReport PicturePair::renderFrame(Renderer& renderer, const FrameInput& first, const FrameInput& second,
                                     const PairLayout& layout, int width, unsigned framebuffer, bool measure) {
  if (first.width <= 0 || second.width <= 0 || first.height <= 0) return {};
  if (!impl_->renderer) impl_->renderer.emplace(impl_->shader_dir);
  impl_->first.prepare(first.width, first.height);
  impl_->second.prepare(second.width, second.height);
  FrameReport report = renderer.renderFrame(first, impl_->first.framebuffer(), measure);
  impl_->renderer->renderFrame(second, impl_->second.framebuffer(), measure);
  const int line = linePixel(layout, width), right = layout.side_by_side ? 0 : line;
  copyColumns(impl_->first.framebuffer(), framebuffer, 0, 0, line, first.height);
  copyColumns(impl_->second.framebuffer(), framebuffer, right, line, width - line, first.height);
  drawLine(framebuffer, line, first.height);
  return report;
}

FrameReport PicturePair::renderImage(Renderer& renderer, const FrameInput& first, const FrameInput& second,
                                     const PairLayout& layout, int width, std::vector<unsigned char>& rgba,
                                     bool measure) {
  rgba.clear();
  if (width <= 0 || first.height <= 0) return {};
  impl_->whole.prepare(width, first.height);
  FrameReport report = renderFrame(renderer, first, second, layout, width, impl_->whole.framebuffer(), measure);
  impl_->whole.read(rgba);
  return report;
}

ReloadReport PicturePair::reloadShaders(Reload which) {
  return impl_->renderer ? impl_->renderer->reloadShaders(which) : ReloadReport{};
}

}  // namespace render
