#include "kiosk/display/headless.h"

#include <cstdio>
#include <string>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace prismesh::kiosk::display {

namespace {

tl::unexpected<Error> no_egl(const std::string& what) {
  char code[16];
  std::snprintf(code, sizeof code, "0x%x", static_cast<unsigned>(eglGetError()));
  return fail("EGL", what + " (EGL error " + code +
                         "); on Debian the packages libegl1, libegl-mesa0 and libgl1-mesa-dri bring a software renderer");
}

bool has_word(const char* words, const std::string& word) {
  return words != nullptr && (" " + std::string(words) + " ").find(" " + word + " ") != std::string::npos;
}

}  // namespace

struct Headless::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
  }
};

Headless::Headless(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Headless::Headless(Headless&&) noexcept = default;
Headless& Headless::operator=(Headless&&) noexcept = default;
Headless::~Headless() = default;

Result<Headless> Headless::create() {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_word(extensions, "EGL_MESA_platform_surfaceless")) return no_egl("this machine's EGL can't draw without a screen");
  auto impl = std::make_unique<Impl>();
  const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) return no_egl("EGL could not be started");
  impl->display = display;
  eglBindAPI(EGL_OPENGL_ES_API);
  const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count == 0) return no_egl("EGL offers no OpenGL ES 3");
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  impl->context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (impl->context == EGL_NO_CONTEXT) return no_egl("the graphics driver has no OpenGL ES 3.1");
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl->context) == EGL_FALSE)
    return no_egl("the graphics context can't be used without a screen");
  return Headless(std::move(impl));
}

}  // namespace prismesh::kiosk::display
