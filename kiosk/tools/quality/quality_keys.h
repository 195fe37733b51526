// The table of keys of reviewing quality, relaxing and repairing.
#pragma once

#include <array>

#include "kiosk/tools/quality/quality_commands.h"

namespace prismesh::kiosk::tools::quality {

inline constexpr std::array kKeys = {
    KeyBinding{display::letter('J'), false, false, command_of(QualityCommand::panel), Menu::mesh, "J", "show or hide quality in figures"},
    KeyBinding{display::Key::right, false, false, command_of(QualityCommand::next_error), Menu::mesh, "Right",
               "go to the next error, worst first", kRepeats},
    KeyBinding{display::Key::left, false, false, command_of(QualityCommand::previous_error), Menu::mesh, "Left", "back to the error before",
               kRepeats},
    KeyBinding{display::letter('J'), false, true, command_of(QualityCommand::damaged_only), Menu::mesh, "Shift+J",
               "glyphs and errors: all, or only what edits made worse"},
    KeyBinding{display::letter('L'), true, false, command_of(QualityCommand::relax_selection), Menu::mesh, "Ctrl+L",
               "relax the selected nodes", kAsksForEdit},
    KeyBinding{display::letter('L'), true, true, command_of(QualityCommand::relax_part), Menu::mesh, "Ctrl+Shift+L",
               "relax the selection's parts", kAsksForEdit},
    KeyBinding{display::letter('L'), false, true, command_of(QualityCommand::relax_from), Menu::mesh, "Shift+L",
               "relax outwards from the node under the pointer", kAsksForEdit},
    KeyBinding{display::letter('J'), true, false, command_of(QualityCommand::relax_failed), Menu::mesh, "Ctrl+J", "relax what fails",
               kAsksForEdit},
    KeyBinding{display::letter('E'), true, false, command_of(QualityCommand::repair_damaged), Menu::mesh, "Ctrl+E",
               "repair what edits made worse", kAsksForEdit},
    KeyBinding{display::letter('E'), true, true, command_of(QualityCommand::repair_selection), Menu::mesh, "Ctrl+Shift+E",
               "repair the shells at the selected nodes", kAsksForEdit},
    KeyBinding{display::letter('J'), true, true, command_of(QualityCommand::repair_all), Menu::mesh, "Ctrl+Shift+J",
               "repair all that warns or fails", kAsksForEdit},
    KeyBinding{display::letter('T'), true, false, command_of(QualityCommand::sheet_limit), Menu::mesh, "Ctrl+T",
               "type how far relaxing and repairing may move nodes within sheets"},
    KeyBinding{display::letter('T'), true, true, command_of(QualityCommand::line_limit), Menu::mesh, "Ctrl+Shift+T",
               "type how far they may move nodes on feature lines"},
    KeyBinding{display::letter('H'), true, false, command_of(QualityCommand::relax_threshold), Menu::mesh, "Ctrl+H",
               "type beyond which movement neighbours join in relaxing from a node"},
};

}  // namespace prismesh::kiosk::tools::quality
