// Loaded into a kiosk (LD_PRELOAD): its graphics card counts as reset as soon as the file that $PRISMESH_TEST_RESET_CARD names is there.
#include <cstdlib>

#include <dlfcn.h>
#include <unistd.h>

#include <EGL/egl.h>

namespace {

bool is_reset() {
  const char* file = std::getenv("PRISMESH_TEST_RESET_CARD");
  return file != nullptr && ::access(file, F_OK) == 0;
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

EGLBoolean eglSwapBuffers(EGLDisplay display, EGLSurface surface) {
  static auto* const swap = real<EGLBoolean(EGLDisplay, EGLSurface)>("eglSwapBuffers");
  return is_reset() ? EGL_FALSE : swap(display, surface);
}

EGLint eglGetError() {
  static auto* const get_error = real<EGLint()>("eglGetError");
  return is_reset() ? EGL_CONTEXT_LOST : get_error();
}
}
