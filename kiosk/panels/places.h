// Where the docked panels stand, and what they leave to the view. No ImGui.
#pragma once

#include <string>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::panels {

/// A rectangle of the picture in pixels from the upper left corner.
struct Place {
  float x = 0, y = 0, width = 0, height = 0;

  float right() const { return x + width; }
  float bottom() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Place&) const = default;
};

/// What the user has set by dragging borders. In font sizes and shares, so that it holds for every picture.
struct Arrangement {
  float dock_ems = 18.5F;    ///< the dock's width
  float upper_share = 0.5F;  ///< of the dock's height: parts, history and model above the tool
  std::string tab{};         ///< the one that is shown above; empty: the first
  bool operator==(const Arrangement&) const = default;
};
/// All of a picture.
inline Place whole(display::PixelSize picture) { return {0, 0, static_cast<float>(picture.width), static_cast<float>(picture.height)}; }

/// The nearest arrangement that can be used: both halves of the dock keep a few rows.
Arrangement within_limits(const Arrangement& wanted);

/// The panels, side by side without a gap; they cover the picture together with `view`. A place that a small picture has no room for is
/// empty.
struct Places {
  Place bar;                ///< menus, undo, the deck's name, the search: along the upper edge
  Place rail;               ///< the tools: at the left
  Place dock;               ///< at the right ...
  Place upper;              ///< ... its tabs, and ...
  Place lower;              ///< ... the tool in hand
  Place options;            ///< of the tool in hand: below the view
  Place status;             ///< along the lower edge
  Place view;               ///< what remains
  bool short_rail = false;  ///< the rail has room for a letter a tool only
};

/// `em`: the font's size in pixels.
Places place_panels(display::PixelSize picture, float em, const Arrangement& arrangement);

}  // namespace prismesh::kiosk::panels
