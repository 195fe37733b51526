// Finds rows in tables of keys, and tells typed numbers from keys.
#pragma once

#include <span>

#include "kiosk/input/command.h"

namespace prismesh::kiosk::input {

/// The row of a key; null: it has none. Shift must match for keys with Ctrl; elsewhere a key with Shift that has no row of its own has that
/// of the plain key.
const KeyBinding* binding_for(std::span<const KeyBinding> table, display::Key key, const display::Modifiers& modifiers);

/// The row of a command, which must be in the table.
const KeyBinding& binding_of(std::span<const KeyBinding> table, const Command& command);

/// Whether a text can begin a number.
bool begins_number(std::string_view text);

}  // namespace prismesh::kiosk::input
