// The panel at the left that lists where parts touch.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "ipc/model/messages.h"
#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::tools::contact {

struct ContactFacts {
  const ipc::Contacts* contacts = nullptr;  ///< null: not here
  bool asking = false;
  bool stale = false;   ///< of an older state
  std::string problem;  ///< why there are none; empty: nothing is wrong
  std::string length_unit;
  std::optional<std::size_t> chosen;  ///< region
  bool chosen_anew = false;           ///< its row must come into sight
};

/// Lays the panel out (inside Gui::layout). Returns the region that was clicked.
std::optional<std::size_t> contact_panel(const ContactFacts& facts, panels::PanelLayout& layout);

}  // namespace prismesh::kiosk::tools::contact
