// The commands and keys that belong to no tool. `rearm` and `fullscreen` are carried out by the window.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/input/command.h"

namespace prismesh::kiosk {

inline constexpr std::string_view kEditorName = "editor";

enum class EditorCommand : std::uint8_t {
  deck_warnings,
  undo,
  redo,
  cancel,
  stop_and_keep,
  rearm,
  fullscreen,
  menu,
  help,
  menu_at_pointer,
  set_up
};

constexpr input::Command command_of(EditorCommand command) { return {kEditorName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kDocumentKeys = {
    input::KeyBinding{display::letter('I'), true, false, command_of(EditorCommand::deck_warnings), input::Menu::file, "Ctrl+I",
                      "list all warnings of the deck"},
    input::KeyBinding{display::letter('Z'), true, false, command_of(EditorCommand::undo), input::Menu::edit, "Ctrl+Z",
                      "undo the last edit, selections included", input::kAsksForEdit | input::kRepeats},
    input::KeyBinding{display::letter('Y'), true, false, command_of(EditorCommand::redo), input::Menu::edit, "Ctrl+Y", "redo",
                      input::kAsksForEdit | input::kRepeats},
};

inline constexpr std::array kCancelKeys = {
    input::KeyBinding{display::Key::space, false, false, command_of(EditorCommand::menu_at_pointer), input::Menu::edit, "Space",
                      "the menu of what is under the pointer"},
    input::KeyBinding{display::Key::escape, false, false, command_of(EditorCommand::cancel), input::Menu::edit, "Esc",
                      "stop what takes long, cancel a drag, close a panel, or clear the selection"},
    input::KeyBinding{display::Key::escape, false, true, command_of(EditorCommand::stop_and_keep), input::Menu::edit, "Shift+Esc",
                      "stop a repair and keep what it has reached; otherwise as Esc"},
};

inline constexpr std::array kWindowKeys = {
    input::KeyBinding{display::Key::f12, false, false, command_of(EditorCommand::set_up), input::Menu::display, "F12",
                      "set the station up: name, network, display, time"},
    input::KeyBinding{display::letter('R'), true, false, command_of(EditorCommand::rearm), input::Menu::display, "Ctrl+R",
                      "try the prism mask again after it was stuck"},
    input::KeyBinding{display::Key::f11, false, false, command_of(EditorCommand::fullscreen), input::Menu::display, "F11",
                      "fullscreen on and off"},
    input::KeyBinding{display::Key::f10, false, false, command_of(EditorCommand::menu), input::Menu::help, "F10",
                      "show or hide all commands as buttons"},
    input::KeyBinding{display::Key::f1, false, false, command_of(EditorCommand::help), input::Menu::help, "F1", "show or hide this help"},
};

}  // namespace prismesh::kiosk
