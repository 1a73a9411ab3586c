// A windowless OpenGL 4.5 core context through EGL, for headless runs and tests.
#pragma once

#include <string>

namespace app {

// Owns an EGL display and a context without a surface (drawing goes to framebuffer objects only); current on the thread
// that made it. Tries Mesa's surfaceless platform, then the EGL devices, then the default display. Loads GL through
// GLEW.
class EglContext {
 public:
  // Throws ContextError that lists every attempt and how each failed. `debug`: the driver checks every call; see
  // render/gl/gl_messages.h.
  explicit EglContext(bool debug = false);
  ~EglContext();
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&& other) noexcept;
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  // Which platform answered, for the report: "surfaceless", "device 0", "default display".
  const std::string& platform() const { return platform_; }

 private:
  void release() noexcept;

  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string platform_;
};

}  // namespace app
