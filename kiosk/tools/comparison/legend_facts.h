// Facts for the legends and the panel for comparing, and what the user sets there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/render/field_colours.h"
#include "kiosk/tools/comparison/compare_wish.h"

namespace prismesh::kiosk::tools::comparison {

struct LegendFacts {
  std::string title, unit;
  std::string of;  ///< "state 3 (lift) against the deck as it was opened"
  render::FieldLook look;
  double min = 0, max = 0;          ///< of the values
  std::string min_at, max_at;       ///< "node:12"
  std::size_t new_nodes = 0;        ///< coloured, but not counted in `min` and `max`
  std::size_t shells_without = 0;   ///< shells whose value is missing
  bool before_pull = false;         ///< a pull is under way, and the values are from before it
  std::optional<double> probed;     ///< the value under the pointer
  std::string probed_at;            ///< "node 12"; empty: nothing is under the pointer
  double centre = 0.5;              ///< of the legend, as a share of the picture's width
  double widest = 1;                ///< its maximum width, as the same share
  std::optional<std::size_t> pane;  ///< whose limits may be changed here; empty: only shown
};

/// New limits for the colours of both views.
struct SetLimits {
  double clear = 0, full = 1;
};

/// The states that can be compared, and what is shown.
struct CompareFacts {
  struct ComparableState {
    std::uint64_t number = 0;
    std::string words;
  };
  CompareWish wish;
  std::vector<ComparableState> states;  ///< oldest first
  /// Which state a view shows.
  struct Caption {
    std::string words;
    double centre = 0.5;  ///< as a share of the picture's width
  };
  std::vector<Caption> captions;  ///< none where there is the current state alone
  std::uint64_t current = 0;
  std::vector<LegendFacts> legends;
  std::string problem;  ///< why there are no colours; empty: there are, or none are wanted
};

/// Text that is being typed on the panel, from one layout to the next.
struct CompareEntry {
  std::string from, to, deck;
};

}  // namespace prismesh::kiosk::tools::comparison
