#include "kiosk/display/kms/input.h"

#include <algorithm>
#include <utility>

namespace prismesh::kiosk::display::kms {

Input::Input(Keyboard keyboard, Clock& clock, PixelSize size)
    : keyboard_(std::move(keyboard)), clock_(clock), size_(size), x_(size.width / 2.0), y_(size.height / 2.0) {}

void Input::set_size(PixelSize size) {
  const PixelSize before = std::exchange(size_, size);
  if (before.width > 0 && before.height > 0) moved(x_ * size.width / before.width, y_ * size.height / before.height);
}

void Input::move_by(double x, double y) { moved(x_ + x, y_ + y); }

void Input::move_to(double x, double y) { moved(x * size_.width, y * size_.height); }

void Input::moved(double x, double y) {
  // The last pixel's middle is the last place.
  x_ = std::clamp(x, 0.0, std::max(0.0, size_.width - 1.0));
  y_ = std::clamp(y, 0.0, std::max(0.0, size_.height - 1.0));
  PointerMoved now{x_, y_, keyboard_.modifiers(), {}};
  if (auto* before = events_.empty() ? nullptr : std::get_if<PointerMoved>(&events_.back())) {
    now.passed = std::move(before->passed);
    now.passed.push_back({before->x, before->y});
    events_.back() = std::move(now);
  } else {
    events_.emplace_back(std::move(now));
  }
}

void Input::button(MouseButton button, bool down, std::int64_t time_ms) {
  // Two devices may hold the same button.
  if (down ? !buttons_.insert(button).second : buttons_.erase(button) == 0) return;
  events_.emplace_back(ButtonChanged{button, down, x_, y_, keyboard_.modifiers(), time_ms});
}

void Input::wheel(double steps) {
  if (steps != 0) events_.emplace_back(WheelTurned{steps, x_, y_, keyboard_.modifiers()});
}

void Input::key(std::uint32_t code, bool down) {
  if (!down) {
    if (keys_.erase(code) == 0) return;
    const Key key = keyboard_.key(code);
    const Modifiers modifiers = keyboard_.modifiers();
    keyboard_.set(code, false);
    events_.emplace_back(KeyChanged{key, false, false, modifiers});
    if (repeated_ == code) repeat_ns_.reset();
    return;
  }
  if (!keys_.insert(code).second) return;
  const KeyMeaning meaning = keyboard_.meaning(code);
  say(meaning, false);
  keyboard_.set(code, true);
  if (meaning.console != 0) console_ = meaning.console;
  if (!meaning.repeats) return;
  repeated_ = code;
  repeat_ns_ = clock_.now_ns() + kFirstRepeatNs;
}

void Input::say(const KeyMeaning& meaning, bool repeat) {
  if (meaning.console != 0) return;
  events_.emplace_back(KeyChanged{meaning.key, true, repeat, keyboard_.modifiers()});
  if (!meaning.text.empty()) events_.emplace_back(TextTyped{meaning.text});
}

void Input::turn() {
  if (!repeat_ns_ || clock_.now_ns() < *repeat_ns_) return;
  say(keyboard_.meaning(repeated_), true);
  // After a slow picture the key doesn't catch up.
  repeat_ns_ = std::max(*repeat_ns_ + kRepeatNs, clock_.now_ns());
}

void Input::lose() {
  keys_.clear();
  buttons_.clear();
  repeat_ns_.reset();
  keyboard_.forget();
  events_.emplace_back(FocusLost{});
}

std::vector<WindowEvent> Input::take() { return std::exchange(events_, {}); }

int Input::take_console() { return std::exchange(console_, 0); }

}  // namespace prismesh::kiosk::display::kms
