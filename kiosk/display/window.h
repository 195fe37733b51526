// Interface to a window: shows the finished picture and gives the input of mouse and keyboard. There is one implementation for each kind of
// display: an X11 window (x11/x11_window.h) and the bare screen (kms/bare_window.h); open_window.h chooses. Coordinates are pixels of the
// picture, x right, y down, from its upper left corner.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"

namespace prismesh::kiosk::display {

struct PixelSize {
  int width = 0;
  int height = 0;
  bool operator==(const PixelSize&) const = default;
};

enum class MouseButton : std::uint8_t { left, middle, right };
inline constexpr int kMouseButtonCount = 3;

struct Modifiers {
  bool shift = false;
  bool ctrl = false;
  bool alt = false;
  bool operator==(const Modifiers&) const = default;
};

/// A key by its meaning on the user's keyboard layout. Letters and digits are their upper-case ASCII codes.
enum class Key : std::uint16_t {
  none = 0,
  space = ' ',
  digit_0 = '0',
  digit_9 = '9',
  letter_a = 'A',
  letter_z = 'Z',
  escape = 256,
  enter,
  tab,
  backspace,
  remove,
  insert,
  left,
  right,
  up,
  down,
  home,
  end,
  page_up,
  page_down,
  f1,
  f2,
  f3,
  f4,
  f5,
  f6,
  f7,
  f8,
  f9,
  f10,
  f11,
  f12,
};
inline constexpr int kKeyCount = static_cast<int>(Key::f12) + 1;
constexpr Key letter(char upper_case) { return static_cast<Key>(upper_case); }

struct PointerMoved {
  double x = 0, y = 0;
  Modifiers modifiers;
  std::vector<std::array<double, 2>> passed{};  ///< positions since the last event, oldest first, without the current one
};
struct ButtonChanged {
  MouseButton button = MouseButton::left;
  bool down = false;
  double x = 0, y = 0;
  Modifiers modifiers;
  std::int64_t time_ms = 0;  ///< of the display's own clock: only differences have a meaning
};
struct WheelTurned {
  double steps = 0;  ///< positive: away from the user
  double x = 0, y = 0;
  Modifiers modifiers;
};
struct KeyChanged {
  Key key = Key::none;
  bool down = false;
  bool repeat = false;
  Modifiers modifiers;
};
struct TextTyped {
  std::string text;  ///< UTF-8, no control characters
};
struct PointerLeft {};
struct FocusLost {};    ///< keys and buttons held down count as released
struct FocusGained {};  ///< on a desktop
struct Resized {
  PixelSize size;
};
struct Moved {};    ///< another position on the desktop, or another monitor or mode: call `position` and `monitor` again
struct Exposed {};  ///< the picture must be shown again
struct CloseRequested {};

using WindowEvent = std::variant<PointerMoved, ButtonChanged, WheelTurned, KeyChanged, TextTyped, PointerLeft, FocusLost, FocusGained,
                                 Resized, Moved, Exposed, CloseRequested>;

struct Monitor;  // monitor.h

class Window {
 public:
  virtual ~Window() = default;
  virtual PixelSize size() const = 0;
  /// Events since the last call, oldest first. Consecutive moves of the pointer are merged into one. Errors: the display is gone.
  virtual Result<std::vector<WindowEvent>> take_events() = 0;
  /// For poll(2): readable if there may be events. Negative: there are never any.
  virtual int descriptor() const = 0;
  struct DesktopPosition {
    int x = 0, y = 0;
    bool operator==(const DesktopPosition&) const = default;
  };
  /// The picture's upper left corner in the desktop's pixels.
  virtual DesktopPosition position() const = 0;
  /// The monitor that shows the largest part of the picture; empty: unknown. It takes requests to the display, so call it after a change,
  /// not for each picture.
  virtual std::optional<Monitor> monitor() = 0;
  /// Waits until the picture in framebuffer 0 is drawn to its last pixel.
  virtual void finish() = 0;
  /// Shows the picture drawn into framebuffer 0 of the window's GL context.
  virtual void present() = 0;
  /// When the display began its newest refresh, CLOCK_MONOTONIC; empty if it doesn't report it.
  virtual std::optional<std::int64_t> last_refresh_ns() = 0;
  /// Whether the display has a pointer of its own. Otherwise every picture draws one.
  virtual bool has_pointer() const { return true; }
  /// Hides or shows the display's own pointer. It isn't woven, so stereo pictures draw their own.
  virtual void show_pointer(bool shown) = 0;
  virtual void set_fullscreen(bool fullscreen) = 0;
  /// What other programs have put on the clipboard, UTF-8; empty: nothing, or the display has none. May wait 0.2 s for its owner.
  virtual std::optional<std::string> clipboard() { return std::nullopt; }
  /// Offers a text to other programs, until they offer one.
  virtual void set_clipboard(const std::string& /*text*/) {}
};

}  // namespace prismesh::kiosk::display
