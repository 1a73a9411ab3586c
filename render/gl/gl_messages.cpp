#include "render/gl/gl_messages.h"

#include <GL/glew.h>

#include <cstdio>
#include <set>
#include <string>

namespace render {
namespace {

long messages = 0;

// Advice on speed is no fault: drivers give it when they compile a shader anew, once a machine.
void GLAPIENTRY onMessage(GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                          const void*) {
  static std::set<std::string> said;
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
  ++messages;
  const std::string words = length < 0 ? std::string(text) : std::string(text, static_cast<std::size_t>(length));
  if (said.insert(words).second) std::fprintf(stderr, "OpenGL: %s\n", words.c_str());
}

}  // namespace

void watchGl() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(&onMessage, nullptr);
}

long glMessageCount() {
  return messages;
}

}  // namespace render
