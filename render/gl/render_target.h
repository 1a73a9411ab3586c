// Offscreen targets: multisampled radiance with depth, and an 8-bit image to read back.
#pragma once

#include <vector>

#include "render/gl/gl_object.h"

namespace render {

// Multisampled half-float radiance and depth; the tone map resolves it.
class RadianceTarget {
 public:
  // Makes it anew when size or samples change; samples are clamped to what the context has. Throws std::runtime_error
  // when the framebuffer is incomplete.
  void prepare(int width, int height, int samples);
  void bind() const;
  GLuint color() const { return color_.id(); }
  int samples() const { return samples_; }

 private:
  Framebuffer framebuffer_;
  Texture color_, depth_;
  int width_ = 0, height_ = 0, asked_ = 0, samples_ = 0;
};

// 8-bit RGBA.
class ImageTarget {
 public:
  void prepare(int width, int height);
  GLuint framebuffer() const { return framebuffer_.id(); }
  GLuint texture() const { return color_.id(); }  // bottom row first; 0: not prepared
  // Top row first.
  void read(std::vector<unsigned char>& rgba) const;

 private:
  Framebuffer framebuffer_;
  Texture color_;
  int width_ = 0, height_ = 0;
};

}  // namespace render
