// The table of keys of shaping.
#pragma once

#include <array>

#include "kiosk/tools/shaping/shaping_commands.h"

namespace prismesh::kiosk::tools::shaping {

inline constexpr std::array kKeys = {
    KeyBinding{display::letter('N'), false, false, command_of(ShapingCommand::type_number), Menu::shape, "N",
               "type how far to lift, slide, move or turn", kAsksForEdit},
    KeyBinding{display::letter('N'), false, true, command_of(ShapingCommand::next_handle), Menu::shape, "Shift+N",
               "what typed numbers do: lift, slide, move"},
    KeyBinding{display::letter('A'), false, false, command_of(ShapingCommand::pick_axis), Menu::shape, "A",
               "pick an axis to turn about: two nodes"},
    KeyBinding{display::letter('A'), false, true, command_of(ShapingCommand::axis_edge), Menu::shape, "Shift+A",
               "the axis is the edge under the pointer: free edges and creases first"},
    KeyBinding{display::letter('X'), false, true, command_of(ShapingCommand::axis_x), Menu::shape, "Shift+X",
               "the axis is the deck's x through the handle"},
    KeyBinding{display::letter('Y'), false, true, command_of(ShapingCommand::axis_y), Menu::shape, "Shift+Y",
               "the axis is the deck's y through the handle"},
    KeyBinding{display::letter('Z'), false, true, command_of(ShapingCommand::axis_z), Menu::shape, "Shift+Z",
               "the axis is the deck's z through the handle"},
    KeyBinding{display::letter('D'), false, true, command_of(ShapingCommand::no_axis), Menu::shape, "Shift+D",
               "no axis: lift, slide and move again"},
    KeyBinding{display::letter('T'), false, false, command_of(ShapingCommand::panel), Menu::shape, "T", "show or hide how pulls fade out"},
    KeyBinding{display::letter('D'), false, false, command_of(ShapingCommand::falloff), Menu::shape, "D", "next profile of the falloff"},
    KeyBinding{display::Key::up, true, false, command_of(ShapingCommand::flatter), Menu::shape, "Ctrl+Up",
               "a wider flat top of the falloff", kRepeats},
    KeyBinding{display::Key::down, true, false, command_of(ShapingCommand::less_flat), Menu::shape, "Ctrl+Down", "a narrower one",
               kRepeats},
    KeyBinding{display::letter('G'), false, true, command_of(ShapingCommand::along), Menu::shape, "Shift+G",
               "fall off in all directions, or along x, y or z only"},
    KeyBinding{display::letter('G'), true, false, command_of(ShapingCommand::along_nodes), Menu::shape, "Ctrl+G",
               "pick the direction of the falloff: two nodes"},
    KeyBinding{display::letter('G'), true, true, command_of(ShapingCommand::along_edge), Menu::shape, "Ctrl+Shift+G",
               "the falloff goes along the edge under the pointer"},
    KeyBinding{display::letter('V'), false, true, command_of(ShapingCommand::along_view), Menu::shape, "Shift+V",
               "the falloff goes along the view's right, up or depth"},
    KeyBinding{display::letter('F'), false, true, command_of(ShapingCommand::free_ends), Menu::shape, "Shift+F",
               "free edges follow the pull whole, follow by distance, or hold"},
    KeyBinding{display::letter('E'), false, true, command_of(ShapingCommand::origin), Menu::shape, "Shift+E",
               "the grab is one node, or its whole free edge"},
    KeyBinding{display::letter('I'), false, true, command_of(ShapingCommand::each_normal), Menu::shape, "Shift+I",
               "lift along the normal at the grab, or each node along its own"},
    KeyBinding{display::letter('T'), false, true, command_of(ShapingCommand::move_limit), Menu::shape, "Shift+T",
               "type the farthest that a node may move"},
    KeyBinding{display::letter('M'), false, false, command_of(ShapingCommand::symmetry), Menu::shape, "M",
               "mirror the pull: off, at x, y or z"},
    KeyBinding{display::letter('M'), false, true, command_of(ShapingCommand::symmetry_place), Menu::shape, "Shift+M",
               "type where the mirror stands"},
    KeyBinding{display::letter('W'), false, true, command_of(ShapingCommand::across_welds), Menu::shape, "Shift+W",
               "pulls go on over welded sheets, or not"},
};

}  // namespace prismesh::kiosk::tools::shaping
