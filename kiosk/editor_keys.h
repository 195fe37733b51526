// The commands and keys that belong to no tool. `rearm` and `fullscreen` are carried out by the window.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kiosk/tools/command.h"

namespace prismesh::kiosk {

inline constexpr std::string_view kEditorName = "editor";

enum class EditorCommand : std::uint8_t { deck_warnings, undo, redo, cancel, stop_and_keep, rearm, fullscreen, menu, help };

constexpr tools::Command command_of(EditorCommand command) { return {kEditorName, static_cast<std::uint8_t>(command)}; }

inline constexpr std::array kDocumentKeys = {
    tools::KeyBinding{display::letter('I'), true, false, command_of(EditorCommand::deck_warnings), tools::Menu::file, "Ctrl+I",
                      "list all warnings of the deck"},
    tools::KeyBinding{display::letter('Z'), true, false, command_of(EditorCommand::undo), tools::Menu::edit, "Ctrl+Z",
                      "undo the last edit, selections included", tools::kAsksForEdit | tools::kRepeats},
    tools::KeyBinding{display::letter('Y'), true, false, command_of(EditorCommand::redo), tools::Menu::edit, "Ctrl+Y", "redo",
                      tools::kAsksForEdit | tools::kRepeats},
};

inline constexpr std::array kCancelKeys = {
    tools::KeyBinding{display::Key::escape, false, false, command_of(EditorCommand::cancel), tools::Menu::edit, "Esc",
                      "stop what takes long, cancel a drag, close a panel, or clear the selection"},
    tools::KeyBinding{display::Key::escape, false, true, command_of(EditorCommand::stop_and_keep), tools::Menu::edit, "Shift+Esc",
                      "stop a repair and keep what it has reached; otherwise as Esc"},
};

inline constexpr std::array kWindowKeys = {
    tools::KeyBinding{display::letter('R'), true, false, command_of(EditorCommand::rearm), tools::Menu::display, "Ctrl+R",
                      "try the prism mask again after it was stuck"},
    tools::KeyBinding{display::Key::f11, false, false, command_of(EditorCommand::fullscreen), tools::Menu::display, "F11",
                      "fullscreen on and off"},
    tools::KeyBinding{display::Key::f10, false, false, command_of(EditorCommand::menu), tools::Menu::help, "F10",
                      "show or hide all commands as buttons"},
    tools::KeyBinding{display::Key::f1, false, false, command_of(EditorCommand::help), tools::Menu::help, "F1", "show or hide this help"},
};

}  // namespace prismesh::kiosk
