// Reads /etc/default/keyboard: the keyboard layout that Debian sets for text consoles and display servers.
#pragma once

#include <string>
#include <string_view>

namespace prismesh::drivers::settings {

/// A keyboard layout by the names that X11 and the text console use; empty: the default.
struct KeyboardNames {
  std::string model, layout, variant, options;
  bool operator==(const KeyboardNames&) const = default;
};

/// Reads the text of Debian's /etc/default/keyboard. Ignores what it doesn't know.
KeyboardNames read_keyboard_names(std::string_view text);

}  // namespace prismesh::drivers::settings
