#include "render/gl/driver.h"

#include <GL/glew.h>

#include <string>

namespace render {
namespace {

bool isNamed(const std::string& renderer, const char* driver) {
  return renderer.find(driver) != std::string::npos;
}

// OpenGL 4.5 does not promise it.
bool vertexStageReadsBuffers() {
  constexpr GLint kRead = 4;  // by strand_grown.vert
  GLint most = 0;
  glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &most);
  return most >= kRead;
}

}  // namespace

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

bool rasterizesInSoftware() {
  const std::string name = rendererName();
  return isNamed(name, "llvmpipe") || isNamed(name, "softpipe") || isNamed(name, "SWR");
}

// Zink names the Vulkan driver under it, and there a map waits for all that was drawn; softpipe interprets its shaders.
// On GPUs compute shaders take a fraction of the geometry stage's time (docs/gpu.md).
StrandPath pathFor(StrandPath asked) {
  if (asked == StrandPath::kCompute && !vertexStageReadsBuffers()) return StrandPath::kGeometry;
  if (asked != StrandPath::kAuto) return asked;
  const std::string name = rendererName();
  return isNamed(name, "llvmpipe") && !isNamed(name, "zink") ? StrandPath::kSoftware : pathFor(StrandPath::kCompute);
}

}  // namespace render
