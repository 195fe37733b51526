// Pieces of the boxes that are typed into below the model. For sources that lay panels out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kiosk/display/window.h"
#include "kiosk/panels/layout.h"

namespace prismesh::kiosk::panels {

/// What a field that is typed into remembers from one layout to the next.
struct EntryState {
  std::string text;
  std::optional<std::size_t> recalled{};  ///< which of the earlier entries stands in the field
  std::string own{};                      ///< what stood there before
  bool caret_to_end = false;
};

/// A box below the model, between the panels at the sides.
void begin_low(const char* name, const Place& room, float width);
/// A field as wide as the box, which takes the keyboard whenever nothing else has it. Up and Down bring earlier entries back. True: Enter
/// was pressed in it. `opened`: the box wasn't there the last time.
bool entry_field(const char* name, const std::vector<std::string>& earlier, bool opened, EntryState& entry);
void small_line(const std::string& text, unsigned colour);

}  // namespace prismesh::kiosk::panels
