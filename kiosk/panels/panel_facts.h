// What the panels that belong to no tool show, as plain data. Knows neither the model server nor the renderer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "kiosk/notices/notice.h"

namespace prismesh::kiosk::panels {

struct DocumentFacts {
  std::string path;
  std::uint64_t nodes = 0, shells = 0, parts = 0;
  std::string length_unit;
  bool length_unit_guessed = false;
  double target_size = 0, largest_target_size = 0;  ///< the range over the parts with shells
  bool target_size_guessed = false;
};

/// What the states kept for undo take and may take, bytes; 0: not known.
struct HistoryFacts {
  std::uint64_t bytes = 0, cap = 0;
};

/// What the picture takes on the graphics card and what is given up for it, in words; without words: nothing is said.
struct VideoMemoryFacts {
  std::string megabytes, given_up;
};

/// What stands in the middle while there is no model to see.
struct StateFacts {
  bool connected = false;
  std::string socket;
  std::string busy;  ///< what the model server is doing; empty: nothing
  double busy_fraction = 0;
};

/// The notice to be read next, and the number of those behind it.
struct NoticeFacts {
  notices::Notice notice;
  std::size_t more = 0;
};

}  // namespace prismesh::kiosk::panels
