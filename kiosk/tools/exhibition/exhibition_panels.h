// What an exhibition lays over the picture: cards, and the pad for the PIN. All inside Gui::layout.
#pragma once

#include <cstdint>
#include <string>

#include "kiosk/panels/panel_layout.h"

namespace prismesh::kiosk::tools::exhibition {

struct ShowCard {
  std::string title, words;
};
/// The show's card, and what to do to try it oneself.
void show_card(const ShowCard& card, panels::PanelLayout& layout);

/// The visit is about to end; any touch keeps it.
void warning_card(int seconds, panels::PanelLayout& layout);

/// The small button for those who know the PIN. True: it was pressed.
bool staff_button(panels::PanelLayout& layout);

enum class UnlockedAsked : std::uint8_t { nothing, lock, leave };
UnlockedAsked unlocked_card(panels::PanelLayout& layout);

struct PinFacts {
  bool has_pin = true;      ///< the settings have one
  std::int64_t wait_s = 0;  ///< until another may be tried
};
struct PinEntry {
  std::string typed;
  bool wrong = false;  ///< the last one was
};
enum class PinAsked : std::uint8_t { nothing, cancel, enter };
/// A pad for fingers, with a field for keyboards.
PinAsked pin_pad(const PinFacts& facts, bool opened, panels::PanelLayout& layout, PinEntry& entry);

}  // namespace prismesh::kiosk::tools::exhibition
