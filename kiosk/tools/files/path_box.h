// The box in which a deck is chosen or a path typed: recent decks, folders, files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/panels/panel_layout.h"
#include "kiosk/tools/files/browse.h"

namespace prismesh::kiosk::tools::files {

enum class PathDialog : std::uint8_t { open, save_as, save_copy };

struct PathFacts {
  PathDialog dialog = PathDialog::open;
  bool opened = false;                 ///< the dialog wasn't there the last time
  std::string deck;                    ///< path of the deck that is open; empty: none
  std::string tried;                   ///< a path that couldn't be opened, to go on with; empty: none
  std::string problem;                 ///< why
  std::vector<RecentDeck> recent;      ///< newest first
  std::vector<BrowseRow> shelf{};      ///< models of the store, newest first
  std::vector<std::string> pairing{};  ///< lines about a pairing code; empty: none was asked for
};

/// What the box remembers from one layout to the next.
struct PathEntry {
  std::string typed;
  std::string begun;  ///< what stood in the field at first: nothing has been typed yet
  bool caret_to_end = false;
  bool all = false;                     ///< lists files that are no decks too
  std::optional<std::size_t> chosen{};  ///< the row that Enter takes; nothing: what is typed
  bool chosen_by_key = false;
  Browsed browsed{};
  std::optional<std::string> browsed_for{};
  bool browsed_all = false;
  bool cancelled = false;  ///< the button was pressed
};

/// Lays the box out (inside Gui::layout). Returns the path that was entered.
std::optional<std::string> path_box(const PathFacts& facts, PathEntry& entry, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::files
