// The panels about the view: the bar with menus, the rail of tools, the row of options and the status line. They show plain data.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kiosk/input/command.h"
#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::panels {

struct BarFacts {
  std::string deck;  ///< the file's name; empty: none is open
  std::string path;
  bool changed = false;
  bool can_undo = false, can_redo = false;
};
/// The commands of the bar's own buttons.
struct BarKeys {
  const input::KeyBinding &undo, &redo, &save;
  const input::KeyBinding* find = nullptr;  ///< null: there is no search
  const input::KeyBinding& help;
};
/// `all`: the commands of the menus. `more`: adds entries to a menu.
void bar_panel(const BarFacts& facts, const BarKeys& keys, std::span<const input::KeyBinding> all,
               const std::function<void(input::Menu)>& more, PanelLayout& layout);

/// A row of a menu: what a command does, and its key.
void menu_row(const input::KeyBinding& binding, PanelLayout& layout);

struct RailButton {
  const char* label = "";
  const input::KeyBinding* key = nullptr;
  bool on = false;
};
void rail_panel(std::span<const RailButton> buttons, PanelLayout& layout);

struct StatusFacts {
  std::string setting;  ///< the tool in hand and how it is set
  std::string pointed;  ///< what is under the pointer, or what a pull does
  std::string selection;
  std::string unit;
  /// A device or daemon: a word, and whether all is well with it.
  struct Light {
    std::string name, state;
    bool good = true;
  };
  std::vector<Light> lights;
};
/// What has no room is left out, the setting first.
void status_panel(const StatusFacts& facts, PanelLayout& layout);

/// Borders that are dragged: the dock's left one and the one between its halves. Returns the arrangement the user wants.
std::optional<Arrangement> borders(const Arrangement& now, PanelLayout& layout);

}  // namespace prismesh::kiosk::panels
