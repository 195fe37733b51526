#include "kiosk/display/x11/x11_window.h"

#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <X11/XKBlib.h>
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/Xrandr.h>

#include "kiosk/display/key_symbols.h"
#include "kiosk/display/x11/x11_clipboard.h"
#include "kiosk/display/x11/x11_monitor.h"

namespace prismesh::kiosk::display::x11 {
namespace {

Modifiers modifiers_from(unsigned state) { return {(state & ShiftMask) != 0, (state & ControlMask) != 0, (state & Mod1Mask) != 0}; }

std::optional<MouseButton> button_from(unsigned button) {
  if (button == Button1) return MouseButton::left;
  if (button == Button2) return MouseButton::middle;
  if (button == Button3) return MouseButton::right;
  return std::nullopt;
}

bool is_wheel(unsigned button) { return button == Button4 || button == Button5; }

/// EGL_CHROMIUM_sync_control: time of the newest refresh in microseconds, number of refreshes, number of swaps.
using GetSyncValues = EGLBoolean (*)(EGLDisplay, EGLSurface, EGLuint64KHR*, EGLuint64KHR*, EGLuint64KHR*);

/// Called when the connection to the X server breaks. Without it Xlib ends the program.
void mark_gone(Display*, void* gone) { *static_cast<bool*>(gone) = true; }

class X11Window final : public Window {
 public:
  ~X11Window() override;
  Result<void> open(const X11Options& options);

  PixelSize size() const override { return size_; }
  Result<std::vector<WindowEvent>> take_events() override;
  int descriptor() const override { return ConnectionNumber(display_); }
  DesktopPosition position() const override { return position_; }
  std::optional<Monitor> monitor() override { return gone_ ? std::nullopt : monitor_at(display_, root(), position_.x, position_.y, size_); }
  void finish() override { eglWaitClient(); }
  void present() override;
  std::optional<std::int64_t> last_refresh_ns() override;
  void show_pointer(bool shown) override;
  void set_fullscreen(bool fullscreen) override;
  std::optional<std::string> clipboard() override { return gone_ ? std::nullopt : clipboard_.read(); }
  void set_clipboard(const std::string& text) override {
    if (!gone_) clipboard_.offer(text);
  }

 private:
  Result<void> create_window(const X11Options& options);
  Result<void> create_context();
  ::Window root() const { return DefaultRootWindow(display_); }
  void find_position(std::vector<WindowEvent>& out);
  void translate(XEvent& event, std::vector<WindowEvent>& out);
  void translate_motion(const XMotionEvent& event, std::vector<WindowEvent>& out);
  void translate_configure(const XConfigureEvent& event, std::vector<WindowEvent>& out);
  void translate_button(const XButtonEvent& event, bool down, std::vector<WindowEvent>& out);
  void translate_key(XKeyEvent& event, bool down, std::vector<WindowEvent>& out);

  Display* display_ = nullptr;
  ::Window window_ = 0;
  XIM input_method_ = nullptr;
  XIC input_context_ = nullptr;
  Cursor no_pointer_ = 0;
  Atom delete_window_ = 0;
  X11Clipboard clipboard_;
  EGLDisplay egl_ = EGL_NO_DISPLAY;
  EGLConfig config_ = nullptr;
  EGLContext context_ = EGL_NO_CONTEXT;
  EGLSurface surface_ = EGL_NO_SURFACE;
  GetSyncValues sync_values_ = nullptr;
  PixelSize size_;
  DesktopPosition position_;
  int randr_events_ = -1;  ///< first event number of RandR; negative: no RandR
  bool position_stale_ = true;
  bool monitor_changed_ = false;
  bool pointer_shown_ = true;
  bool gone_ = false;
  std::optional<Error> not_shown_;  ///< why the last picture isn't on the screen; take_events returns it
  std::array<bool, 256> held_{};    ///< by key code: a press while held is a repeat
};

X11Window::~X11Window() {
  if (display_ == nullptr || gone_) return;  // a broken connection can't be closed
  if (egl_ != EGL_NO_DISPLAY) {
    eglMakeCurrent(egl_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface_ != EGL_NO_SURFACE) eglDestroySurface(egl_, surface_);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(egl_, context_);
    eglTerminate(egl_);
  }
  if (input_context_ != nullptr) XDestroyIC(input_context_);
  if (input_method_ != nullptr) XCloseIM(input_method_);
  if (no_pointer_ != 0) XFreeCursor(display_, no_pointer_);
  if (window_ != 0) XDestroyWindow(display_, window_);
  XCloseDisplay(display_);
}

Result<void> X11Window::open(const X11Options& options) {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0')
    return fail("",
                "no display: set DISPLAY to an X server's name (for example :0), or use --headless-frames N --shots DIR to draw pictures");
  display_ = XOpenDisplay(nullptr);
  if (display_ == nullptr)
    return fail(
        name,
        "no X server answers there: start one, set DISPLAY to one that runs, or use --headless-frames N --shots DIR to draw pictures");
  XSetIOErrorHandler([](Display*) { return 0; });  // take_events returns the error
  XSetIOErrorExitHandler(display_, mark_gone, &gone_);
  XkbSetDetectableAutoRepeat(display_, True, nullptr);

  egl_ = eglGetPlatformDisplay(EGL_PLATFORM_X11_KHR, display_, nullptr);
  EGLint major = 0, minor = 0;
  if (egl_ == EGL_NO_DISPLAY || !eglInitialize(egl_, &major, &minor))
    return fail(name, "this display has no EGL: install Mesa (libegl-mesa0, libgl1-mesa-dri)");
  eglBindAPI(EGL_OPENGL_ES_API);
  if (Result<void> created = create_window(options); !created) return created;
  return create_context();
}

Result<void> X11Window::create_window(const X11Options& options) {
  // The window needs no depth buffer or multisampling: the scene is drawn off screen and only composed into it.
  const EGLint wanted[] = {
      EGL_SURFACE_TYPE, EGL_WINDOW_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8,
      EGL_NONE};
  EGLint found = 0, visual_id = 0;
  if (!eglChooseConfig(egl_, wanted, &config_, 1, &found) || found == 0)
    return fail(DisplayString(display_), "this display offers no 24-bit window with OpenGL ES 3");
  eglGetConfigAttrib(egl_, config_, EGL_NATIVE_VISUAL_ID, &visual_id);

  XVisualInfo pattern{};
  pattern.visualid = static_cast<VisualID>(visual_id);
  int visuals = 0;
  XVisualInfo* visual = XGetVisualInfo(display_, VisualIDMask, &pattern, &visuals);
  if (visual == nullptr) return fail(DisplayString(display_), "this display has no visual that EGL can draw to");
  const ::Window root = RootWindow(display_, visual->screen);
  XSetWindowAttributes attributes{};
  attributes.colormap = XCreateColormap(display_, root, visual->visual, AllocNone);
  attributes.event_mask = ButtonPressMask | ButtonReleaseMask | PointerMotionMask | LeaveWindowMask | KeyPressMask | KeyReleaseMask |
                          StructureNotifyMask | ExposureMask | FocusChangeMask;
  size_ = options.fullscreen ? PixelSize{DisplayWidth(display_, visual->screen), DisplayHeight(display_, visual->screen)} : options.size;
  window_ = XCreateWindow(display_, root, 0, 0, static_cast<unsigned>(size_.width), static_cast<unsigned>(size_.height), 0, visual->depth,
                          InputOutput, visual->visual, CWColormap | CWEventMask, &attributes);
  XFree(visual);

  Xutf8SetWMProperties(display_, window_, options.title.c_str(), options.title.c_str(), nullptr, 0, nullptr, nullptr, nullptr);
  delete_window_ = XInternAtom(display_, "WM_DELETE_WINDOW", False);
  XSetWMProtocols(display_, window_, &delete_window_, 1);
  if (options.fullscreen) {
    Atom fullscreen = XInternAtom(display_, "_NET_WM_STATE_FULLSCREEN", False);
    XChangeProperty(display_, window_, XInternAtom(display_, "_NET_WM_STATE", False), XA_ATOM, 32, PropModeReplace,
                    reinterpret_cast<unsigned char*>(&fullscreen), 1);
  }
  input_method_ = XOpenIM(display_, nullptr, nullptr, nullptr);
  if (input_method_ != nullptr)
    input_context_ = XCreateIC(input_method_, XNInputStyle, XIMPreeditNothing | XIMStatusNothing, XNClientWindow, window_, XNFocusWindow,
                               window_, nullptr);
  int randr_errors = 0;
  if (XRRQueryExtension(display_, &randr_events_, &randr_errors) != 0)
    XRRSelectInput(display_, root, RRScreenChangeNotifyMask | RRCrtcChangeNotifyMask | RROutputPropertyNotifyMask);
  else
    randr_events_ = -1;
  clipboard_ = X11Clipboard(display_, window_);
  XMapWindow(display_, window_);
  XFlush(display_);
  return {};
}

Result<void> X11Window::create_context() {
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  context_ = eglCreateContext(egl_, config_, EGL_NO_CONTEXT, version);
  if (context_ == EGL_NO_CONTEXT) return fail(DisplayString(display_), "this display's driver doesn't know OpenGL ES 3.1");
  surface_ = eglCreatePlatformWindowSurface(egl_, config_, &window_, nullptr);
  if (surface_ == EGL_NO_SURFACE || !eglMakeCurrent(egl_, surface_, surface_, context_))
    return fail(DisplayString(display_), "EGL can't draw to a window here (error " + std::to_string(eglGetError()) + ")");
  eglSwapInterval(egl_, 1);
  const char* extensions = eglQueryString(egl_, EGL_EXTENSIONS);
  if (extensions != nullptr && std::string_view(extensions).find("EGL_CHROMIUM_sync_control") != std::string_view::npos)
    sync_values_ = reinterpret_cast<GetSyncValues>(eglGetProcAddress("eglGetSyncValuesCHROMIUM"));
  return {};
}

Result<std::vector<WindowEvent>> X11Window::take_events() {
  std::vector<WindowEvent> out;
  while (!gone_ && XPending(display_) > 0) {
    XEvent event;
    XNextEvent(display_, &event);
    if (XFilterEvent(&event, window_)) continue;
    translate(event, out);
  }
  if (!gone_) find_position(out);
  if (gone_) return fail("", "the X server has gone away");
  if (not_shown_) return fail(*not_shown_);
  return out;
}

/// A window manager puts the window into a frame of its own, so only the X server knows its position on the desktop.
void X11Window::find_position(std::vector<WindowEvent>& out) {
  if (!position_stale_ && !monitor_changed_) return;
  int x = position_.x, y = position_.y;
  ::Window child = 0;
  if (window_ != 0) XTranslateCoordinates(display_, window_, root(), 0, 0, &x, &y, &child);
  if (monitor_changed_ || DesktopPosition{x, y} != position_) out.emplace_back(Moved{});
  position_ = {x, y};
  position_stale_ = monitor_changed_ = false;
}

void X11Window::present() {
  if (gone_ || eglSwapBuffers(egl_, surface_) != EGL_FALSE) return;
  const EGLint error = eglGetError();
  if (error == EGL_BAD_SURFACE || error == EGL_BAD_NATIVE_WINDOW) return;  // the window is being closed
  // Everything that was given to the card would have to be made anew: a new kiosk does that, and the document is the model server's.
  not_shown_ = Error{DisplayString(display_), 0,
                     error == EGL_CONTEXT_LOST
                         ? "the graphics card was reset, and the picture is lost. Nothing of the model is: start the kiosk again"
                         : "the graphics card shows no picture any more (error " + std::to_string(error) +
                               "). Nothing of the model is lost: start the kiosk again"};
}

std::optional<std::int64_t> X11Window::last_refresh_ns() {
  EGLuint64KHR time_us = 0, refreshes = 0, swaps = 0;
  if (gone_ || sync_values_ == nullptr || !sync_values_(egl_, surface_, &time_us, &refreshes, &swaps) || time_us == 0) return std::nullopt;
  return static_cast<std::int64_t>(time_us) * 1000;
}

void X11Window::translate(XEvent& event, std::vector<WindowEvent>& out) {
  if (randr_events_ >= 0 && (event.type == randr_events_ + RRScreenChangeNotify || event.type == randr_events_ + RRNotify)) {
    XRRUpdateConfiguration(&event);
    monitor_changed_ = true;
    return;
  }
  if (clipboard_.handle(event)) return;
  switch (event.type) {
    case MotionNotify: translate_motion(event.xmotion, out); break;
    case ButtonPress:
    case ButtonRelease: translate_button(event.xbutton, event.type == ButtonPress, out); break;
    case KeyPress:
    case KeyRelease: translate_key(event.xkey, event.type == KeyPress, out); break;
    case LeaveNotify:
      if (event.xcrossing.mode == NotifyNormal) out.emplace_back(PointerLeft{});
      break;
    case FocusOut:
      held_.fill(false);
      out.emplace_back(FocusLost{});
      break;
    case FocusIn: out.emplace_back(FocusGained{}); break;
    case ReparentNotify: position_stale_ = true; break;
    case ConfigureNotify: translate_configure(event.xconfigure, out); break;
    case Expose:
      if (event.xexpose.count == 0) out.emplace_back(Exposed{});
      break;
    case MappingNotify: XRefreshKeyboardMapping(&event.xmapping); break;
    case ClientMessage:
      if (static_cast<Atom>(event.xclient.data.l[0]) == delete_window_) out.emplace_back(CloseRequested{});
      break;
    case DestroyNotify:  // another client destroyed the window
      window_ = 0;
      out.emplace_back(CloseRequested{});
      break;
    default: break;
  }
}

void X11Window::translate_motion(const XMotionEvent& event, std::vector<WindowEvent>& out) {
  PointerMoved moved{static_cast<double>(event.x), static_cast<double>(event.y), modifiers_from(event.state), {}};
  if (auto* before = out.empty() ? nullptr : std::get_if<PointerMoved>(&out.back())) {
    moved.passed = std::move(before->passed);
    moved.passed.push_back({before->x, before->y});
    out.back() = std::move(moved);
  } else {
    out.emplace_back(std::move(moved));
  }
}

void X11Window::translate_configure(const XConfigureEvent& event, std::vector<WindowEvent>& out) {
  position_stale_ = true;
  const PixelSize now{event.width, event.height};
  if (now == size_) return;
  size_ = now;
  if (!out.empty() && std::holds_alternative<Resized>(out.back())) out.pop_back();
  out.emplace_back(Resized{now});
}

void X11Window::translate_button(const XButtonEvent& event, bool down, std::vector<WindowEvent>& out) {
  const auto x = static_cast<double>(event.x), y = static_cast<double>(event.y);
  if (is_wheel(event.button)) {
    if (down) out.emplace_back(WheelTurned{event.button == Button4 ? 1.0 : -1.0, x, y, modifiers_from(event.state)});
    return;
  }
  if (const std::optional<MouseButton> button = button_from(event.button))
    out.emplace_back(ButtonChanged{*button, down, x, y, modifiers_from(event.state), static_cast<std::int64_t>(event.time)});
}

void X11Window::translate_key(XKeyEvent& event, bool down, std::vector<WindowEvent>& out) {
  std::array<char, 64> text{};
  KeySym symbol = NoSymbol;
  int length = 0;
  if (down && input_context_ != nullptr) {
    Status status = 0;
    length = Xutf8LookupString(input_context_, &event, text.data(), static_cast<int>(text.size()), &symbol, &status);
    if (status == XBufferOverflow || status == XLookupNone || status == XLookupKeySym) length = 0;
  }
  // The symbol without modifiers identifies the key: Shift+1 is still the digit.
  KeySym plain = XLookupKeysym(&event, 0);
  if (key_from_symbol(static_cast<std::uint32_t>(plain)) == Key::none) plain = symbol;
  const Modifiers modifiers = modifiers_from(event.state);
  bool& held = held_[event.keycode & 0xffu];
  out.emplace_back(KeyChanged{key_from_symbol(static_cast<std::uint32_t>(plain)), down, down && held, modifiers});
  held = down;
  const bool printable = length > 0 && static_cast<unsigned char>(text[0]) >= 0x20 && text[0] != 0x7f;
  if (down && printable && !modifiers.ctrl && !modifiers.alt)
    out.emplace_back(TextTyped{std::string(text.data(), static_cast<std::size_t>(length))});
}

void X11Window::show_pointer(bool shown) {
  if (shown == pointer_shown_ || gone_) return;
  pointer_shown_ = shown;
  if (no_pointer_ == 0) {
    const char empty[1] = {0};
    const Pixmap nothing = XCreateBitmapFromData(display_, window_, empty, 1, 1);
    XColor black{};
    no_pointer_ = XCreatePixmapCursor(display_, nothing, nothing, &black, &black, 0, 0);
    XFreePixmap(display_, nothing);
  }
  if (shown)
    XUndefineCursor(display_, window_);
  else
    XDefineCursor(display_, window_, no_pointer_);
  XFlush(display_);
}

void X11Window::set_fullscreen(bool fullscreen) {
  if (gone_) return;
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window_;
  event.xclient.message_type = XInternAtom(display_, "_NET_WM_STATE", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = fullscreen ? 1 : 0;
  event.xclient.data.l[1] = static_cast<long>(XInternAtom(display_, "_NET_WM_STATE_FULLSCREEN", False));
  event.xclient.data.l[3] = 1;  // source: application
  XSendEvent(display_, DefaultRootWindow(display_), False, SubstructureNotifyMask | SubstructureRedirectMask, &event);
  XFlush(display_);
}

}  // namespace

Result<std::unique_ptr<Window>> open_x11_window(const X11Options& options) {
  auto window = std::make_unique<X11Window>();
  if (Result<void> opened = window->open(options); !opened) return fail(opened.error());
  return window;
}

}  // namespace prismesh::kiosk::display::x11
