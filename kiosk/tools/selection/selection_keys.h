// The table of keys of selecting.
#pragma once

#include <array>

#include "kiosk/tools/selection/selection_commands.h"

namespace prismesh::kiosk::tools::selection {

inline constexpr std::array kKeys = {
    KeyBinding{display::letter('E'), false, false, command_of(SelectionCommand::expression), Menu::select, "E",
               "select by an id expression", kAsksForEdit},
    KeyBinding{display::letter('L'), false, false, command_of(SelectionCommand::outline_kind), Menu::select, "L",
               "draw outlines as a lasso, or as rectangles"},
    KeyBinding{display::letter('V'), false, false, command_of(SelectionCommand::toggle_through), Menu::select, "V",
               "outlines take visible nodes, or all through the model"},
    KeyBinding{display::letter('G'), false, false, command_of(SelectionCommand::grow), Menu::select, "G", "grow the selection by a ring",
               kAsksForEdit | kRepeats},
    KeyBinding{display::letter('B'), false, false, command_of(SelectionCommand::shrink), Menu::select, "B",
               "shrink the selection by a ring", kAsksForEdit | kRepeats},
    KeyBinding{display::letter('I'), false, false, command_of(SelectionCommand::invert), Menu::select, "I", "invert the selection",
               kAsksForEdit},
    KeyBinding{display::letter('R'), false, false, command_of(SelectionCommand::region), Menu::select, "R",
               "select the region under the pointer", kAsksForEdit},
    KeyBinding{display::letter('R'), false, true, command_of(SelectionCommand::region_by), Menu::select, "Shift+R",
               "what bounds regions: creases, the part, the piece, a free edge"},
    KeyBinding{display::Key::page_up, false, true, command_of(SelectionCommand::wider_angle), Menu::select, "Shift+PgUp",
               "regions go on over sharper creases", kRepeats},
    KeyBinding{display::Key::page_down, false, true, command_of(SelectionCommand::narrower_angle), Menu::select, "Shift+PgDn",
               "regions end at blunter creases", kRepeats},
    KeyBinding{display::letter('W'), false, false, command_of(SelectionCommand::region_across_welds), Menu::select, "W",
               "regions go on over welded sheets, or not"},
};

}  // namespace prismesh::kiosk::tools::selection
