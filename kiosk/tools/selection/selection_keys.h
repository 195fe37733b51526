// The table of keys of selecting.
#pragma once

#include <array>

#include "kiosk/tools/selection/selection_commands.h"

namespace prismesh::kiosk::tools::selection {

inline constexpr std::array kKeys = {
    input::KeyBinding{display::Key::f2, false, false, command_of(SelectionCommand::take_in_hand), input::Menu::select, "F2",
                      "select: take it in hand, as at the start"},
    input::KeyBinding{display::letter('E'), false, false, command_of(SelectionCommand::expression), input::Menu::select, "E",
                      "select by an id expression", input::kAsksForEdit | input::kOpensField},
    input::KeyBinding{display::letter('L'), false, false, command_of(SelectionCommand::outline_kind), input::Menu::select, "L",
                      "draw outlines as a lasso, or as rectangles"},
    input::KeyBinding{display::letter('V'), false, false, command_of(SelectionCommand::toggle_through), input::Menu::select, "V",
                      "outlines take visible nodes, or all through the model"},
    input::KeyBinding{display::letter('G'), false, false, command_of(SelectionCommand::grow), input::Menu::select, "G",
                      "grow the selection by a ring", input::kAsksForEdit | input::kRepeats},
    input::KeyBinding{display::letter('B'), false, false, command_of(SelectionCommand::shrink), input::Menu::select, "B",
                      "shrink the selection by a ring", input::kAsksForEdit | input::kRepeats},
    input::KeyBinding{display::letter('I'), false, false, command_of(SelectionCommand::invert), input::Menu::select, "I",
                      "invert the selection", input::kAsksForEdit},
    input::KeyBinding{display::letter('R'), false, false, command_of(SelectionCommand::region), input::Menu::select, "R",
                      "select the region under the pointer", input::kAsksForEdit | input::kAtPointer},
    input::KeyBinding{display::letter('R'), false, true, command_of(SelectionCommand::region_by), input::Menu::select, "Shift+R",
                      "what bounds regions: creases, the part, the piece, a free edge"},
    input::KeyBinding{display::Key::page_up, false, true, command_of(SelectionCommand::wider_angle), input::Menu::select, "Shift+PgUp",
                      "regions go on over sharper creases", input::kRepeats},
    input::KeyBinding{display::Key::page_down, false, true, command_of(SelectionCommand::narrower_angle), input::Menu::select, "Shift+PgDn",
                      "regions end at blunter creases", input::kRepeats},
    input::KeyBinding{display::letter('W'), false, false, command_of(SelectionCommand::region_across_welds), input::Menu::select, "W",
                      "regions go on over welded sheets, or not"},
};

}  // namespace prismesh::kiosk::tools::selection
