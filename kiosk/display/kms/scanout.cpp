#include "kiosk/display/kms/scanout.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <drm_fourcc.h>
#include <fmt/format.h>
#include <gbm.h>
#include <xf86drmMode.h>

namespace prismesh::kiosk::display::kms {
namespace {

/// The pictures of one size.
struct Pictures {
  gbm_surface* memory = nullptr;
  EGLSurface surface = EGL_NO_SURFACE;
};

/// Of a buffer object, which GBM uses again: its framebuffer.
struct Framebuffer {
  int descriptor = -1;
  ObjectId id = 0;
};

void drop_framebuffer(gbm_bo*, void* data) {
  const std::unique_ptr<Framebuffer> framebuffer(static_cast<Framebuffer*>(data));
  if (framebuffer->id != 0) drmModeRmFB(framebuffer->descriptor, framebuffer->id);
}

class GbmScanout final : public Scanout {
 public:
  GbmScanout(int descriptor, std::string name) : descriptor_(descriptor), name_(std::move(name)) {}
  ~GbmScanout() override;
  GbmScanout(const GbmScanout&) = delete;
  GbmScanout& operator=(const GbmScanout&) = delete;
  Result<void> open(PixelSize size);

  Result<void> resize(PixelSize size) override;
  Result<ObjectId> swap() override;
  void release(ObjectId framebuffer) override;

 private:
  struct Held {
    ObjectId framebuffer = 0;
    gbm_bo* buffer = nullptr;
    std::shared_ptr<Pictures> pictures;
  };
  tl::unexpected<Error> problem(const std::string& what) const;
  Result<void> choose_config();
  Result<ObjectId> framebuffer_of(gbm_bo* buffer) const;
  std::shared_ptr<Pictures> own(Pictures made);

  int descriptor_;
  std::string name_;
  gbm_device* device_ = nullptr;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLConfig config_ = nullptr;
  EGLContext context_ = EGL_NO_CONTEXT;
  std::shared_ptr<Pictures> pictures_;  ///< that are drawn now
  std::vector<Held> held_;
};

tl::unexpected<Error> GbmScanout::problem(const std::string& what) const {
  return fail(name_,
              fmt::format("{} (EGL error 0x{:x}); on Debian the packages libgbm1, libegl-mesa0 and libgl1-mesa-dri bring the drivers", what,
                          static_cast<unsigned>(eglGetError())));
}

GbmScanout::~GbmScanout() {
  if (display_ != EGL_NO_DISPLAY) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  for (const Held& held : held_) gbm_surface_release_buffer(held.pictures->memory, held.buffer);
  held_.clear();
  pictures_.reset();
  if (display_ != EGL_NO_DISPLAY) {
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }
  if (device_ != nullptr) gbm_device_destroy(device_);
}

std::shared_ptr<Pictures> GbmScanout::own(Pictures made) {
  return {new Pictures(made), [display = display_](Pictures* pictures) {
            const std::unique_ptr<Pictures> end(pictures);
            if (end->surface != EGL_NO_SURFACE) eglDestroySurface(display, end->surface);
            if (end->memory != nullptr) gbm_surface_destroy(end->memory);
          }};
}

Result<void> GbmScanout::open(PixelSize size) {
  device_ = gbm_create_device(descriptor_);
  if (device_ == nullptr) return problem("the graphics card's driver gives no memory that it can show");
  display_ = eglGetPlatformDisplay(EGL_PLATFORM_GBM_KHR, device_, nullptr);
  if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) return problem("EGL can't be started on it");
  eglBindAPI(EGL_OPENGL_ES_API);
  if (Result<void> chosen = choose_config(); !chosen) return chosen;
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  context_ = eglCreateContext(display_, config_, EGL_NO_CONTEXT, version);
  if (context_ == EGL_NO_CONTEXT) return problem("its driver has no OpenGL ES 3.1");
  return resize(size);
}

/// GBM shows only what has exactly its pixel format, and EGL sorts formats with more bits to the front.
Result<void> GbmScanout::choose_config() {
  const EGLint wanted[] = {
      EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8,
      EGL_NONE};
  std::array<EGLConfig, 256> configs{};
  EGLint count = 0;
  eglChooseConfig(display_, wanted, configs.data(), static_cast<EGLint>(configs.size()), &count);
  for (EGLint i = 0; i < count; ++i) {
    EGLint format = 0;
    eglGetConfigAttrib(display_, configs[static_cast<std::size_t>(i)], EGL_NATIVE_VISUAL_ID, &format);
    if (static_cast<std::uint32_t>(format) != GBM_FORMAT_XRGB8888) continue;
    config_ = configs[static_cast<std::size_t>(i)];
    return {};
  }
  return problem("its driver offers no 24-bit pictures with OpenGL ES 3");
}

Result<void> GbmScanout::resize(PixelSize size) {
  Pictures made;
  made.memory = gbm_surface_create(device_, static_cast<std::uint32_t>(size.width), static_cast<std::uint32_t>(size.height),
                                   GBM_FORMAT_XRGB8888, GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING);
  if (made.memory == nullptr) return problem(fmt::format("it has no memory for pictures of {}x{}", size.width, size.height));
  made.surface = eglCreatePlatformWindowSurface(display_, config_, made.memory, nullptr);
  std::shared_ptr<Pictures> owned = own(made);
  if (made.surface == EGL_NO_SURFACE) return problem(fmt::format("EGL can't draw pictures of {}x{}", size.width, size.height));
  if (eglMakeCurrent(display_, made.surface, made.surface, context_) == EGL_FALSE) return problem("its OpenGL ES context can't be used");
  pictures_ = std::move(owned);
  return {};
}

Result<ObjectId> GbmScanout::framebuffer_of(gbm_bo* buffer) const {
  if (const auto* known = static_cast<const Framebuffer*>(gbm_bo_get_user_data(buffer)); known != nullptr) return known->id;
  std::array<std::uint32_t, 4> handles{gbm_bo_get_handle(buffer).u32}, strides{gbm_bo_get_stride(buffer)}, offsets{};
  ObjectId id = 0;
  const std::uint64_t modifier = gbm_bo_get_modifier(buffer);
  int done = -1;
  if (modifier != DRM_FORMAT_MOD_INVALID && gbm_bo_get_plane_count(buffer) == 1) {
    const std::array<std::uint64_t, 4> modifiers{modifier};
    done = drmModeAddFB2WithModifiers(descriptor_, gbm_bo_get_width(buffer), gbm_bo_get_height(buffer), DRM_FORMAT_XRGB8888, handles.data(),
                                      strides.data(), offsets.data(), modifiers.data(), &id, DRM_MODE_FB_MODIFIERS);
  }
  if (done != 0)
    done = drmModeAddFB2(descriptor_, gbm_bo_get_width(buffer), gbm_bo_get_height(buffer), DRM_FORMAT_XRGB8888, handles.data(),
                         strides.data(), offsets.data(), &id, 0);
  if (done != 0) return fail(name_, fmt::format("the graphics card can't show the memory of a picture ({})", std::strerror(errno)));
  gbm_bo_set_user_data(buffer, new Framebuffer{descriptor_, id}, drop_framebuffer);
  return id;
}

Result<ObjectId> GbmScanout::swap() {
  if (eglSwapBuffers(display_, pictures_->surface) == EGL_FALSE) {
    if (const EGLint error = eglGetError(); error == EGL_CONTEXT_LOST)
      return fail(name_, "the graphics card was reset, and the picture is lost");
    return fail(name_, "the graphics card has ended no picture: it is gone, or out of memory");
  }
  gbm_bo* buffer = gbm_surface_lock_front_buffer(pictures_->memory);
  if (buffer == nullptr) return fail(name_, "the graphics card has no memory left for the next picture");
  Result<ObjectId> framebuffer = framebuffer_of(buffer);
  if (!framebuffer) {
    gbm_surface_release_buffer(pictures_->memory, buffer);
    return framebuffer;
  }
  held_.push_back({*framebuffer, buffer, pictures_});
  return framebuffer;
}

void GbmScanout::release(ObjectId framebuffer) {
  const auto found = std::find_if(held_.begin(), held_.end(), [&](const Held& held) { return held.framebuffer == framebuffer; });
  if (found == held_.end()) return;
  gbm_surface_release_buffer(found->pictures->memory, found->buffer);
  held_.erase(found);
}

}  // namespace

Result<std::unique_ptr<Scanout>> Scanout::create(int descriptor, std::string name, PixelSize size) {
  auto scanout = std::make_unique<GbmScanout>(descriptor, std::move(name));
  if (Result<void> opened = scanout->open(size); !opened) return fail(opened.error());
  return scanout;
}

}  // namespace prismesh::kiosk::display::kms
