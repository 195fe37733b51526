// The table of keys of shaping.
#pragma once

#include <array>

#include "kiosk/tools/shaping/shaping_commands.h"

namespace prismesh::kiosk::tools::shaping {

inline constexpr std::array kKeys = {
    input::KeyBinding{display::letter('N'), false, false, command_of(ShapingCommand::type_number), input::Menu::shape, "N",
                      "type how far to lift, slide, move or turn", input::kAsksForEdit | input::kOpensField},
    input::KeyBinding{display::letter('N'), false, true, command_of(ShapingCommand::next_handle), input::Menu::shape, "Shift+N",
                      "what typed numbers do: lift, slide, move"},
    input::KeyBinding{display::letter('A'), false, false, command_of(ShapingCommand::pick_axis), input::Menu::shape, "A",
                      "pick an axis to turn about: two nodes"},
    input::KeyBinding{display::letter('A'), false, true, command_of(ShapingCommand::axis_edge), input::Menu::shape, "Shift+A",
                      "the axis is the edge under the pointer: free edges and creases first", input::kAtPointer},
    input::KeyBinding{display::letter('X'), false, true, command_of(ShapingCommand::axis_x), input::Menu::shape, "Shift+X",
                      "the axis is the deck's x through the handle"},
    input::KeyBinding{display::letter('Y'), false, true, command_of(ShapingCommand::axis_y), input::Menu::shape, "Shift+Y",
                      "the axis is the deck's y through the handle"},
    input::KeyBinding{display::letter('Z'), false, true, command_of(ShapingCommand::axis_z), input::Menu::shape, "Shift+Z",
                      "the axis is the deck's z through the handle"},
    input::KeyBinding{display::letter('D'), false, true, command_of(ShapingCommand::no_axis), input::Menu::shape, "Shift+D",
                      "no axis: lift, slide and move again"},
    input::KeyBinding{display::letter('T'), false, false, command_of(ShapingCommand::panel), input::Menu::shape, "T",
                      "pull: show or hide how pulls fade out"},
    input::KeyBinding{display::letter('R'), true, true, command_of(ShapingCommand::rigid), input::Menu::shape, "Ctrl+Shift+R",
                      "rigid: all selected nodes move as far as the hand; or falloff: less toward the border"},
    input::KeyBinding{display::letter('D'), false, false, command_of(ShapingCommand::falloff), input::Menu::shape, "D",
                      "next profile of the falloff"},
    input::KeyBinding{display::Key::up, true, false, command_of(ShapingCommand::flatter), input::Menu::shape, "Ctrl+Up",
                      "a wider flat top of the falloff", input::kRepeats},
    input::KeyBinding{display::Key::down, true, false, command_of(ShapingCommand::less_flat), input::Menu::shape, "Ctrl+Down",
                      "a narrower one", input::kRepeats},
    input::KeyBinding{display::letter('G'), false, true, command_of(ShapingCommand::along), input::Menu::shape, "Shift+G",
                      "fall off in all directions, or along x, y or z only"},
    input::KeyBinding{display::letter('G'), true, false, command_of(ShapingCommand::along_nodes), input::Menu::shape, "Ctrl+G",
                      "pick the direction of the falloff: two nodes"},
    input::KeyBinding{display::letter('G'), true, true, command_of(ShapingCommand::along_edge), input::Menu::shape, "Ctrl+Shift+G",
                      "the falloff goes along the edge under the pointer", input::kAtPointer},
    input::KeyBinding{display::letter('V'), false, true, command_of(ShapingCommand::along_view), input::Menu::shape, "Shift+V",
                      "the falloff goes along the view's right, up or depth"},
    input::KeyBinding{display::letter('F'), false, true, command_of(ShapingCommand::free_ends), input::Menu::shape, "Shift+F",
                      "free edges follow the pull whole, follow by distance, or hold"},
    input::KeyBinding{display::letter('E'), false, true, command_of(ShapingCommand::origin), input::Menu::shape, "Shift+E",
                      "the grab is one node, or its whole free edge"},
    input::KeyBinding{display::letter('I'), false, true, command_of(ShapingCommand::each_normal), input::Menu::shape, "Shift+I",
                      "lift along the normal at the grab, or each node along its own"},
    input::KeyBinding{display::letter('T'), false, true, command_of(ShapingCommand::move_limit), input::Menu::shape, "Shift+T",
                      "type the farthest that a node may move"},
    input::KeyBinding{display::letter('M'), false, false, command_of(ShapingCommand::symmetry), input::Menu::shape, "M",
                      "mirror the pull: off, at x, y or z"},
    input::KeyBinding{display::letter('M'), false, true, command_of(ShapingCommand::symmetry_place), input::Menu::shape, "Shift+M",
                      "type where the mirror stands"},
    input::KeyBinding{display::letter('W'), false, true, command_of(ShapingCommand::across_welds), input::Menu::shape, "Shift+W",
                      "pulls go on over welded sheets, or not"},
    input::KeyBinding{display::letter('D'), true, true, command_of(ShapingCommand::keep_apart), input::Menu::shape, "Ctrl+Shift+D",
                      "keep parts apart: pulls, relaxing and repairing make no new contact, or they may"},
};

}  // namespace prismesh::kiosk::tools::shaping
