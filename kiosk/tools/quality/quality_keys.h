// The table of keys of reviewing quality, relaxing and repairing.
#pragma once

#include <array>

#include "kiosk/tools/quality/quality_commands.h"

namespace prismesh::kiosk::tools::quality {

inline constexpr std::array kKeys = {
    input::KeyBinding{display::letter('J'), false, false, command_of(QualityCommand::panel), input::Menu::mesh, "J",
                      "quality: show or hide its figures"},
    input::KeyBinding{display::Key::right, false, false, command_of(QualityCommand::next_error), input::Menu::mesh, "Right",
                      "go to the next error, worst first", input::kRepeats},
    input::KeyBinding{display::Key::left, false, false, command_of(QualityCommand::previous_error), input::Menu::mesh, "Left",
                      "back to the error before", input::kRepeats},
    input::KeyBinding{display::letter('J'), false, true, command_of(QualityCommand::damaged_only), input::Menu::mesh, "Shift+J",
                      "glyphs and errors: all, only what edits made worse, or no glyphs"},
    input::KeyBinding{display::letter('L'), true, false, command_of(QualityCommand::relax_selection), input::Menu::mesh, "Ctrl+L",
                      "relax the selected nodes", input::kAsksForEdit},
    input::KeyBinding{display::letter('L'), true, true, command_of(QualityCommand::relax_part), input::Menu::mesh, "Ctrl+Shift+L",
                      "relax the selection's parts", input::kAsksForEdit},
    input::KeyBinding{display::letter('L'), false, true, command_of(QualityCommand::relax_from), input::Menu::mesh, "Shift+L",
                      "relax outwards from the node under the pointer", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('J'), true, false, command_of(QualityCommand::relax_failed), input::Menu::mesh, "Ctrl+J",
                      "relax what fails", input::kAsksForEdit},
    input::KeyBinding{display::letter('E'), true, false, command_of(QualityCommand::repair_damaged), input::Menu::mesh, "Ctrl+E",
                      "repair what edits made worse", input::kAsksForEdit},
    input::KeyBinding{display::letter('E'), true, true, command_of(QualityCommand::repair_selection), input::Menu::mesh, "Ctrl+Shift+E",
                      "repair the shells at the selected nodes", input::kAsksForEdit},
    input::KeyBinding{display::letter('J'), true, true, command_of(QualityCommand::repair_all), input::Menu::mesh, "Ctrl+Shift+J",
                      "repair all that warns or fails", input::kAsksForEdit},
    input::KeyBinding{display::letter('T'), true, false, command_of(QualityCommand::sheet_limit), input::Menu::mesh, "Ctrl+T",
                      "type how far relaxing and repairing may move nodes within sheets"},
    input::KeyBinding{display::letter('T'), true, true, command_of(QualityCommand::line_limit), input::Menu::mesh, "Ctrl+Shift+T",
                      "type how far they may move nodes on feature lines"},
    input::KeyBinding{display::letter('H'), true, false, command_of(QualityCommand::relax_threshold), input::Menu::mesh, "Ctrl+H",
                      "type beyond which movement neighbours join in relaxing from a node"},
};

}  // namespace prismesh::kiosk::tools::quality
