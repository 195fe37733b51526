// What keys mean: the keyboard layout, dead keys, modifiers (xkbcommon).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/error.h"
#include "drivers/settings/keyboard_names.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::display::kms {

using drivers::settings::KeyboardNames;

/// What a key does. Codes are evdev's (linux/input-event-codes.h).
struct KeyMeaning {
  Key key = Key::none;  ///< without modifiers
  std::string text;     ///< UTF-8 that it types; empty: none
  int console = 0;      ///< the text console that the user asks for; 0: none
  bool repeats = false;
};

class Keyboard {
 public:
  /// Errors: xkbcommon doesn't know a name.
  static Result<Keyboard> create(const KeyboardNames& names);
  Keyboard(Keyboard&&) noexcept;
  Keyboard& operator=(Keyboard&&) noexcept;
  ~Keyboard();

  /// The key of a code, without modifiers.
  Key key(std::uint32_t code) const;
  /// The meaning of a press, or of a repeat of it, with the modifiers that are held and the dead keys that were pressed before.
  KeyMeaning meaning(std::uint32_t code);
  /// A key goes down or up.
  void set(std::uint32_t code, bool down);
  Modifiers modifiers() const;
  /// All keys count as released.
  void forget();

 private:
  struct Impl;
  explicit Keyboard(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::kiosk::display::kms
