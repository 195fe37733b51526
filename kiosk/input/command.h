// Commands with their keys: what the rows of the tools' tables hold. The program, its menu, its help panel and docs/kiosk.md share them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::input {

/// A command by the name of who carries it out, a tool or the editor, and its number there.
struct Command {
  std::string_view owner;
  std::uint8_t number = 0;
  bool operator==(const Command&) const = default;
};

enum class Menu : std::uint8_t { file, edit, select, shape, mesh, parts, view, display, help };
inline constexpr std::array<std::string_view, 9> kMenuNames{"File", "Edit", "Select", "Shape", "Mesh", "Parts", "View", "Display", "Help"};

/// What a key does beside its command.
enum KeyTraits : std::uint8_t {
  kPlainKey = 0,
  kAsksForEdit = 1,  ///< edits the model, the selection or the parts' states, or begins to
  kRepeats = 2,      ///< repeats while the key is held down
  kOpensField = 8,   ///< only opens a field that is typed into
  kAtPointer = 4,    ///< acts on what is under the pointer: stands in the menu there
};

struct KeyBinding {
  display::Key key = display::Key::none;
  bool ctrl = false;
  bool shift = false;
  Command command;
  Menu menu = Menu::file;    ///< the menu that has its entry
  std::string_view label;    ///< the key as people write it: "Ctrl+Shift+S"
  std::string_view meaning;  ///< what it does, a short sentence part; the entry's text
  int traits = kPlainKey;    ///< of KeyTraits

  bool asks_for_edit() const { return (traits & kAsksForEdit) != 0; }
  bool opens_field() const { return (traits & kOpensField) != 0; }
  bool at_pointer() const { return (traits & kAtPointer) != 0; }
  bool repeats() const { return (traits & kRepeats) != 0; }
};

constexpr display::Key digit_key(int value) { return static_cast<display::Key>('0' + value); }

}  // namespace prismesh::kiosk::input
