// THE STORY of a frame: renderFrame. Needs a current OpenGL 4.5 core context with GLEW initialised (see initGl).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/frame_input.h"
#include "render/frame_report.h"
#include "render/gl/driver.h"
#include "render/reload.h"

namespace render {

class Renderer {
 public:
  // `shader_dir`: where the shader files are. Throws std::runtime_error with file, line and the driver's words when a
  // shader does not compile.
  explicit Renderer(std::string shader_dir);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Draws into `framebuffer` (0: the window's) at input.width x input.height.
  FrameReport renderFrame(const FrameInput& input, unsigned framebuffer, bool measure = false);

  // Draws into an offscreen target and reads it back: 8-bit RGBA sRGB, top row first.
  FrameReport renderImage(const FrameInput& input, std::vector<unsigned char>& rgba, bool measure = false);

  // Compiles shaders anew from their files. A program that fails stays as it was.
  ReloadReport reloadShaders(Reload which);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace render
