#include "render/gl/render_target.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace render {
namespace {

void requireComplete(const Framebuffer& framebuffer, const char* name) {
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer.id(), GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(std::string(name) + ": framebuffer incomplete (status " + std::to_string(status) +
                             "); try a smaller size or fewer samples");
  }
}

}  // namespace

void RadianceTarget::prepare(int width, int height, int samples) {
  if (width == width_ && height == height_ && samples == asked_) return;
  GLint most = 1, most_depth = 1;
  glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &most);
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &most_depth);
  width_ = width;
  height_ = height;
  asked_ = samples;
  samples_ = std::clamp(samples, 1, std::max(std::min(most, most_depth), 1));
  color_ = makeTexture(GL_TEXTURE_2D_MULTISAMPLE);
  depth_ = makeTexture(GL_TEXTURE_2D_MULTISAMPLE);
  glTextureStorage2DMultisample(color_.id(), samples_, GL_RGBA16F, width, height, GL_TRUE);
  glTextureStorage2DMultisample(depth_.id(), samples_, GL_DEPTH_COMPONENT32F, width, height, GL_TRUE);
  framebuffer_ = makeFramebuffer();
  glNamedFramebufferTexture(framebuffer_.id(), GL_COLOR_ATTACHMENT0, color_.id(), 0);
  glNamedFramebufferTexture(framebuffer_.id(), GL_DEPTH_ATTACHMENT, depth_.id(), 0);
  requireComplete(framebuffer_, "radiance target");
}

void RadianceTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, width_, height_);
}

void ImageTarget::prepare(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  color_ = makeTexture(GL_TEXTURE_2D);
  glTextureStorage2D(color_.id(), 1, GL_RGBA8, width, height);
  framebuffer_ = makeFramebuffer();
  glNamedFramebufferTexture(framebuffer_.id(), GL_COLOR_ATTACHMENT0, color_.id(), 0);
  requireComplete(framebuffer_, "image target");
}

void ImageTarget::read(std::vector<unsigned char>& rgba) const {
  const std::size_t row = static_cast<std::size_t>(width_) * 4;
  rgba.resize(row * height_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(color_.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba.size()), rgba.data());
  for (int y = 0; y < height_ / 2; ++y) {
    std::swap_ranges(rgba.begin() + static_cast<std::ptrdiff_t>(row * y),
                     rgba.begin() + static_cast<std::ptrdiff_t>(row * (y + 1)),
                     rgba.begin() + static_cast<std::ptrdiff_t>(row * (height_ - 1 - y)));
  }
}

}  // namespace render
