// Panels that tell what happens: a notice at the bottom, the state of the model server in the middle, what to do next at the top.
#pragma once

#include <cstdint>
#include <string>

#include "kiosk/display/window.h"
#include "kiosk/panels/panel_facts.h"
#include "kiosk/panels/places.h"
#include "kiosk/panels/widgets.h"

namespace prismesh::kiosk::panels {

struct NoticePlace {
  double bottom = 0;                       ///< pixels: the lower edge
  const input::KeyBinding& list_warnings;  ///< for the hint of its button
};
enum class NoticeReply : std::uint8_t { none, read, list_warnings };
NoticeReply notice_panel(const NoticeFacts& facts, const Place& room, const NoticePlace& place);

/// `open`: the command that opens a deck; a button where none is open.
void state_panel(const StateFacts& facts, const input::KeyBinding& open, PanelLayout& layout);

/// At the top, where it is in nobody's way.
void guidance_panel(const std::string& guidance, const Place& room);

}  // namespace prismesh::kiosk::panels
