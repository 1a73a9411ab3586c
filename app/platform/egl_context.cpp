#include "app/platform/egl_context.h"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <utility>
#include <vector>

#include "app/files/errors.h"
#include "render/gl/gl_messages.h"
#include "render/renderer.h"

namespace app {
namespace {

struct Candidate {
  std::string name;
  EGLDisplay display;
};

bool hasClientExtension(const char* name) {
  const char* all = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return all != nullptr && std::strstr(all, name) != nullptr;
}

bool drawsOnProcessor(EGLDeviceEXT device) {
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
  const char* all = query != nullptr ? query(device, EGL_EXTENSIONS) : nullptr;
  return all != nullptr && std::strstr(all, "EGL_MESA_device_software") != nullptr;
}

// The displays worth trying, best first: GPUs, unless LIBGL_ALWAYS_SOFTWARE (Mesa's variable) is set; surfaceless,
// which needs neither a window system nor a device node, but is Mesa's own, which draws on the processor beside another
// maker's driver; then what else there is.
std::vector<Candidate> candidateDisplays() {
  std::vector<Candidate> gpus, others;
  const auto get_platform_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_platform_display != nullptr && hasClientExtension("EGL_MESA_platform_surfaceless")) {
    others.push_back(
        {"surfaceless", get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  }
  const auto query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  if (get_platform_display != nullptr && query_devices != nullptr && hasClientExtension("EGL_EXT_platform_device")) {
    const bool software = std::getenv("LIBGL_ALWAYS_SOFTWARE") != nullptr;
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
      for (EGLint i = 0; i < count; ++i) {
        (software || drawsOnProcessor(devices[i]) ? others : gpus)
            .push_back(
                {"device " + std::to_string(i), get_platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
      }
    }
  }
  others.push_back({"default display", eglGetDisplay(EGL_DEFAULT_DISPLAY)});
  gpus.insert(gpus.end(), others.begin(), others.end());
  return gpus;
}

std::string eglFault(const char* call) {
  std::ostringstream text;
  text << call << " failed (EGL error 0x" << std::hex << eglGetError() << ")";
  return text.str();
}

// Makes a 4.5 core context current on `display`. Returns the fault in words; empty when all is well. On a fault the
// display is terminated and nothing stays current.
std::string makeContext(EGLDisplay display, bool debug, EGLContext& context) {
  if (display == EGL_NO_DISPLAY) return "no such display";
  if (!eglInitialize(display, nullptr, nullptr)) return eglFault("eglInitialize");
  const auto fail = [&](std::string fault) {
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    context = EGL_NO_CONTEXT;
    eglTerminate(display);
    return fault;
  };
  if (!eglBindAPI(EGL_OPENGL_API)) return fail(eglFault("eglBindAPI"));
  const EGLint config_attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint config_count = 0;
  if (!eglChooseConfig(display, config_attributes, &config, 1, &config_count) || config_count == 0) {
    return fail(eglFault("eglChooseConfig"));
  }
  // The attribute of debug contexts is refused by displays before EGL 1.5: it comes last, and only where it is wanted.
  const EGLint context_attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                       4,
                                       EGL_CONTEXT_MINOR_VERSION,
                                       5,
                                       EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                       EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                       debug ? EGL_CONTEXT_OPENGL_DEBUG : EGL_NONE,
                                       EGL_TRUE,
                                       EGL_NONE};
  context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes);
  if (context == EGL_NO_CONTEXT) return fail(eglFault("eglCreateContext for OpenGL 4.5 core"));
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) return fail(eglFault("eglMakeCurrent"));
  std::string fault = render::initGl();
  if (!fault.empty()) return fail(fault);
  if (debug) render::watchGl();
  return {};
}

}  // namespace

EglContext::EglContext(bool debug) {
  std::ostringstream tried;
  for (const Candidate& candidate : candidateDisplays()) {
    EGLContext context = EGL_NO_CONTEXT;
    const std::string fault = makeContext(candidate.display, debug, context);
    if (fault.empty()) {
      display_ = candidate.display;
      context_ = context;
      platform_ = candidate.name;
      return;
    }
    tried << "\n  " << candidate.name << ": " << fault;
  }
  throw ContextError("no OpenGL 4.5 context without a window; tried:" + tried.str() +
                     "\n  install a driver, or Mesa's software one: apt install libegl1 libgl1-mesa-dri");
}

EglContext::~EglContext() {
  release();
}

EglContext::EglContext(EglContext&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)),
      context_(std::exchange(other.context_, nullptr)),
      platform_(std::move(other.platform_)) {}

EglContext& EglContext::operator=(EglContext&& other) noexcept {
  if (this != &other) {
    release();
    display_ = std::exchange(other.display_, nullptr);
    context_ = std::exchange(other.context_, nullptr);
    platform_ = std::move(other.platform_);
  }
  return *this;
}

void EglContext::release() noexcept {
  if (display_ == nullptr) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // The display is shared by every context of the process on this platform, so it is not terminated here.
  display_ = nullptr;
  context_ = nullptr;
}

}  // namespace app
