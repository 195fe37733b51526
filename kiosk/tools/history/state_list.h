// Lays out the list of states that undo and redo move among, and of their branches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::tools::history {

struct StateRow {
  std::uint64_t generation = 0;
  std::string words;
  bool selects = false;  ///< made by an edit of the selection alone
};

struct BranchRow {
  std::uint64_t number = 0;
  std::string words;             ///< "2 states, from Hide"
  std::string states;            ///< "Lift, Lock"
  std::uint64_t generation = 0;  ///< its newest state
};

struct StateFacts {
  std::vector<StateRow> states;  ///< oldest first
  std::optional<std::size_t> current;
  std::vector<BranchRow> branches;
};

/// "Select region", "As opened": what made a state, for people.
std::string words_of_maker(std::string_view made_by);

/// Inside Gui::layout. `follow`: scrolls to the current state. Returns the state that was clicked, or the newest of a branch.
std::optional<std::uint64_t> state_list(const StateFacts& facts, bool follow, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::history
