// THE STORY of a frame: renderFrame. Needs a current OpenGL 4.5 core context with GLEW initialised (see initGl).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/frame_input.h"
#include "render/reload.h"

namespace render {

struct StageTime {
  const char* name;
  double milliseconds;
};

// How much of something was left out, and of how much.
struct SkipCount {
  long skipped = 0, of = 0;
  SkipCount& operator+=(const SkipCount& other) {
    skipped += other.skipped;
    of += other.of;
    return *this;
  }
};

// One count for each of the DrawSkips.
struct DrawSkipCounts {
  SkipCount frame, rows, shadows, view, shadow_view, body_parts, body_detail, strands, segments, shadow_detail, skin,
      shading, hair_light, sky_visibility;
};

// What a frame did. Times: GPU timer queries where the driver's are usable, glFinish and a steady clock on software
// rasterizers when `measure` is asked for.
struct FrameReport {
  std::vector<StageTime> stages;
  long strands_drawn = 0, strand_vertices = 0, draw_calls = 0;
  long bytes_uploaded = 0;
  long gpu_bytes_hair = 0;     // positions, tangents, layout: everything kept on the GPU for hair models
  long gpu_bytes_shadows = 0;  // all shadow maps
  DrawSkipCounts skip_counts;
};

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

// Loads OpenGL functions through GLEW; accepts GLEW_ERROR_NO_GLX_DISPLAY, which GLX builds answer under EGL although
// all is loaded. Returns an error message, empty when fine. Needs a current context.
std::string initGl();

// "vendor / renderer / version" of the current context.
std::string rendererName();

}  // namespace render
