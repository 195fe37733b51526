// Where the finished picture goes and where the hand's input comes from. One implementation a kind of display: an X11 window
// (x11.h). Coordinates are pixels of the picture, x right, y down, from its upper left corner.
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

/// A key by what it means on the user's layout: letters and digits are their upper-case ASCII codes.
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
  std::vector<std::array<double, 2>> passed{};  ///< where it was since the last event, oldest first, without where it is now
};
struct ButtonChanged {
  MouseButton button = MouseButton::left;
  bool down = false;
  double x = 0, y = 0;
  Modifiers modifiers;
  std::int64_t time_ms = 0;  ///< of the display's own clock: only differences mean something
};
struct WheelTurned {
  double steps = 0;  ///< away from the hand is positive
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
struct FocusLost {};  ///< keys and buttons held down count as released
struct Resized {
  PixelSize size;
};
struct Moved {};    ///< another place on the desktop, or another monitor or mode: ask `place` and `monitor` again
struct Exposed {};  ///< the picture has to be shown again
struct CloseRequested {};

using WindowEvent = std::variant<PointerMoved, ButtonChanged, WheelTurned, KeyChanged, TextTyped, PointerLeft, FocusLost, Resized, Moved,
                                 Exposed, CloseRequested>;

struct Monitor;  // monitor.h

class Window {
 public:
  virtual ~Window() = default;
  virtual PixelSize size() const = 0;
  /// What happened since the last call, oldest first; moves of the pointer that nothing separates come as one. Errors: the
  /// display is gone.
  virtual Result<std::vector<WindowEvent>> take_events() = 0;
  /// For poll(2): readable when there may be events. Negative: there never are any.
  virtual int descriptor() const = 0;
  /// The picture's upper left corner in the desktop's pixels.
  struct Place {
    int x = 0, y = 0;
    bool operator==(const Place&) const = default;
  };
  virtual Place place() const = 0;
  /// The monitor that shows most of the picture; empty: unknown. Asks the display: once when something changed, not for each picture.
  virtual std::optional<Monitor> monitor() = 0;
  /// Waits until the picture in framebuffer 0 is drawn to its last pixel.
  virtual void finish() = 0;
  /// Shows the picture drawn into framebuffer 0 of the window's GL context.
  virtual void present() = 0;
  /// When the display began its newest refresh, CLOCK_MONOTONIC; empty where it doesn't tell.
  virtual std::optional<std::int64_t> last_refresh_ns() = 0;
  /// Hides or shows the display's own pointer (it lies on the woven picture; stereo pictures carry their own).
  virtual void show_pointer(bool shown) = 0;
  virtual void set_fullscreen(bool fullscreen) = 0;
};

}  // namespace prismesh::kiosk::display
