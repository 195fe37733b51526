// The box that a deck's path is typed into.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/places.h"

namespace prismesh::kiosk::tools::files {

enum class PathDialog : std::uint8_t { open, save_as, save_copy };

struct PathFacts {
  PathDialog dialog = PathDialog::open;
  bool opened = false;  ///< the dialog wasn't there the last time
  std::string deck;     ///< path of the deck that is open; empty: none
};

/// What the box remembers from one layout to the next.
struct PathEntry {
  std::string typed;
  bool caret_to_end = false;
  std::vector<std::string> offered;
  std::string offered_for;
};

/// Lays the box out (inside Gui::layout). Returns the path that was entered.
std::optional<std::string> path_box(const PathFacts& facts, const panels::Place& room, PathEntry& entry);

}  // namespace prismesh::kiosk::tools::files
