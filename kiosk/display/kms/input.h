// Turns what mice, keyboards, pen tablets and touch screens do into a window's events: one pointer for all of them, kept inside the
// picture, keys that repeat while they are held, and keys and buttons that count as released when the seat is lost.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "base/clock.h"
#include "kiosk/display/kms/keyboard.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::display::kms {

class Input {
 public:
  /// A held key repeats for the first time after this, and then in this rhythm, as X11's default.
  static constexpr std::int64_t kFirstRepeatNs = 600'000'000;
  static constexpr std::int64_t kRepeatNs = 40'000'000;

  Input(Keyboard keyboard, Clock& clock, PixelSize size);

  /// The pointer is moved into the picture.
  void set_size(PixelSize size);
  /// Pixels of the picture.
  void move_by(double x, double y);
  /// Fractions of the picture, 0 to 1: tablets and touch screens.
  void move_to(double x, double y);
  void button(MouseButton button, bool down, std::int64_t time_ms);
  /// Positive: away from the user. A step is a notch of the wheel.
  void wheel(double steps);
  /// By its evdev code.
  void key(std::uint32_t code, bool down);
  /// Repeats the held key, if it is time to.
  void turn();
  /// When `turn` must be called; nothing: no key is held.
  std::optional<std::int64_t> next_ns() const { return repeat_ns_; }
  /// The input devices have been taken away.
  void lose();

  /// The events since the last call, oldest first. Consecutive moves of the pointer are one.
  std::vector<WindowEvent> take();
  /// The text console that the user has asked for; 0: none. Each is returned once.
  int take_console();

 private:
  void moved(double x, double y);
  void say(const KeyMeaning& meaning, bool repeat);

  Keyboard keyboard_;
  Clock& clock_;
  PixelSize size_;
  double x_, y_;
  std::set<std::uint32_t> keys_;  ///< held
  std::set<MouseButton> buttons_;
  std::uint32_t repeated_ = 0;  ///< the key that repeats
  std::optional<std::int64_t> repeat_ns_;
  int console_ = 0;
  std::vector<WindowEvent> events_;
};

}  // namespace prismesh::kiosk::display::kms
