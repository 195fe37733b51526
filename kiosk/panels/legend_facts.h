// What the legends and the panel for comparing show, and what they give back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/render/field_colours.h"
#include "kiosk/tools/compare_wish.h"

namespace prismesh::kiosk::panels {

struct LegendFacts {
  std::string title, unit;
  std::string of;  ///< "state 3 (lift) against the deck as it was opened"
  render::FieldLook look;
  double min = 0, max = 0;          ///< of the values
  std::string min_at, max_at;       ///< "node:12"
  std::size_t new_nodes = 0;        ///< coloured, and in no figure
  std::size_t shells_without = 0;   ///< that should have a value
  bool before_pull = false;         ///< something is being pulled, and the values are those from before
  double centre = 0.5;              ///< of the legend, as a share of the picture's width
  double widest = 1;                ///< the same of the room that it has
  std::optional<std::size_t> pane;  ///< whose limits may be changed here; empty: only shown
};

/// New limits for the colours of both views.
struct SetLimits {
  double clear = 0, full = 1;
};

/// What can be compared, and what is.
struct CompareFacts {
  struct State {
    std::uint64_t number = 0;
    std::string words;
  };
  tools::CompareWish wish;
  std::vector<State> states;  ///< oldest first
  /// Which state is seen where.
  struct Caption {
    std::string words;
    double centre = 0.5;  ///< as a share of the picture's width
  };
  std::vector<Caption> captions;  ///< none where there is the current state alone
  std::uint64_t current = 0;
  bool panel_open = false;
  std::vector<LegendFacts> legends;
  std::string problem;  ///< why there are no colours; empty: there are, or none are wanted
};

/// What is being typed on the panel, from one layout to the next.
struct CompareEntry {
  std::string from, to, deck;
};

struct SetCompare {
  tools::CompareWish wish;
};

}  // namespace prismesh::kiosk::panels
