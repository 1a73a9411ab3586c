// Hair in an OpenGL program of its own: its context, its framebuffer, its loop; the library moves the hair, hairmesh's
// shaders draw it. Without a window. draw HAIR.obj SHADERS OUT.ppm [FRAMES]
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glew.h>
#include <hairmesh.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "render/renderer.h"
constexpr int kWidth = 640, kHeight = 480;

void must(bool fine, const char* what = hm_error_message()) {
  if (!fine) throw std::runtime_error(what);
}

void makeContext() {
  const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  must(eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API), "no EGL display");
  const EGLint any[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
  EGLConfig config{};
  EGLint count = 0;
  must(eglChooseConfig(display, any, &config, 1, &count) && count > 0, "no EGL configuration");
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  must(context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context), "no OpenGL 4.5 context");
  must(render::initGl().empty(), "OpenGL's functions are not found");
}

std::vector<render::HairFace> facesOf(const hm_mesh_info& info) {
  std::vector<render::HairFace> faces(info.face_count);
  for (int f = 0; f < info.face_count; ++f) {
    render::HairFace& face = faces[f];
    face.layers = info.layer_count;
    for (int k = 0; k < 4 && info.faces[4 * f + k] >= 0; ++k) {
      const int column = info.faces[4 * f + k], first = info.column_first[column];
      face.first_vertex[k] = first;
      face.layers = std::min(face.layers, info.column_first[column + 1] - first);
    }
    const double *a = info.rest.data + 3 * face.first_vertex[0], *c = info.rest.data + 3 * face.first_vertex[2];
    face.area = static_cast<float>(std::pow(c[0] - a[0], 2) + std::pow(c[1] - a[1], 2) + std::pow(c[2] - a[2], 2));
  }
  return faces;
}

int main(int count, char** arguments) try {
  must(count > 3, "draw HAIR.obj SHADERS OUT.ppm [FRAMES]");
  std::ifstream stream(arguments[1], std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  hm_mesh mesh;
  hm_hair hair;
  hm_mesh_info info;
  must(hm_mesh_create_from_text(text.data(), text.size(), arguments[1], 0, &mesh) == HM_OK);
  must(hm_hair_create(mesh, nullptr, &hair) == HM_OK);
  must(hm_mesh_describe(mesh, &info) == HM_OK);

  makeContext();
  render::Renderer renderer(arguments[2]);
  GLuint color, framebuffer;
  glCreateRenderbuffers(1, &color);
  glNamedRenderbufferStorage(color, GL_RGBA8, kWidth, kHeight);
  glCreateFramebuffers(1, &framebuffer);
  glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);

  const std::vector<render::HairFace> faces = facesOf(info);
  std::vector<float> positions(3 * info.vertex_count);
  render::HairInput drawn;
  drawn.faces = faces, drawn.positions = positions;
  render::FrameInput frame;
  frame.width = kWidth, frame.height = kHeight;
  frame.camera.eye = {0.3f, 0.15f, 0.8f}, frame.camera.target = {0, 0.05f, 0};
  frame.view.ground_height = -0.3f;
  frame.hairs = {&drawn, 1};
  for (int n = 1, frames = count > 4 ? std::atoi(arguments[4]) : 60; n <= frames; ++n) {
    hm_step_input step;
    hm_default_step_input(&step);
    const double half = 0.5 * std::sin(0.1 * n);
    step.head.rotation[1] = std::sin(half), step.head.rotation[3] = std::cos(half);
    must(hm_hair_step(hair, &step, nullptr) == HM_OK);
    const hm_target target{positions.data(), 0, static_cast<std::size_t>(info.vertex_count), HM_FLOAT32};
    must(hm_hair_read_positions(hair, &target) == HM_OK);
    drawn.position_revision = static_cast<std::uint64_t>(n);
    renderer.renderFrame(frame, framebuffer);
  }
  std::string pixels(3 * kWidth * kHeight, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  std::ofstream out(arguments[3], std::ios::binary);
  out << "P6\n640 480\n255\n";
  for (int row = kHeight - 1; row >= 0; --row) out.write(pixels.data() + 3 * kWidth * row, 3 * kWidth);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
