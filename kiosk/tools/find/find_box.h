// The box that commands and ids are typed into: a field, and below it what fits.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::tools::find {

/// A row below the field.
struct FindRow {
  std::string words;
  std::string key;  ///< at the right: a command's key, or what a place is
};

struct FindFacts {
  std::vector<FindRow> rows;
  std::string problem;  ///< why there are none
};

/// What the box remembers from one layout to the next.
struct FindEntry {
  std::string typed;
  std::size_t chosen = 0;
  bool caret_to_end = false, chosen_by_key = false;
};

/// Lays the box out (inside Gui::layout). Returns the row that was taken, by Enter or a click. `opened`: it wasn't there the last time.
std::optional<std::size_t> find_box(const FindFacts& facts, bool opened, FindEntry& entry, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::find
