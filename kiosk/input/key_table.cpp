#include "kiosk/input/key_table.h"

#include <algorithm>

namespace prismesh::kiosk::input {

const KeyBinding* binding_for(std::span<const KeyBinding> table, display::Key key, const display::Modifiers& modifiers) {
  if (modifiers.alt) return nullptr;
  const auto find = [&](bool shift) -> const KeyBinding* {
    for (const KeyBinding& binding : table)
      if (binding.key == key && binding.ctrl == modifiers.ctrl && binding.shift == shift) return &binding;
    return nullptr;
  };
  if (const KeyBinding* exactly = find(modifiers.shift); exactly != nullptr || modifiers.ctrl) return exactly;
  return find(false);
}

const KeyBinding& binding_of(std::span<const KeyBinding> table, const Command& command) {
  return *std::find_if(table.begin(), table.end(), [&](const KeyBinding& binding) { return binding.command == command; });
}

bool begins_number(std::string_view text) {
  return !text.empty() && (text[0] == '-' || text[0] == '+' || text[0] == '.' || (text[0] >= '0' && text[0] <= '9'));
}

}  // namespace prismesh::kiosk::input
