// Data of a monitor and of its link to the graphics card, as far as a display server reports them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/display/edid.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::display {

/// Colour format between the graphics card and the panel.
enum class LinkColour : std::uint8_t { unknown, full, halved };  ///< halved: YCbCr 4:2:2 or 4:2:0

/// A monitor and its link. What can't be determined is empty or 0.
struct Monitor {
  std::string connector;  ///< "DP-1"
  std::optional<drivers::display::Edid> edid;
  int x = 0, y = 0;          ///< its upper left corner in the desktop's pixels
  PixelSize shown;           ///< size of its part of the desktop
  PixelSize mode;            ///< size of the picture that is sent to it
  PixelSize native;          ///< size of the panel: its preferred mode
  double refresh_hz = 0;     ///< 0: unknown
  bool transformed = false;  ///< the graphics card resamples (scale, shear, "underscan")
  bool turned = false;       ///< rotated or mirrored by the graphics card
  LinkColour colour = LinkColour::unknown;
};

/// Reads the colour format from a graphics driver's own setting for the connector ("rgb", "ycbcr444", "YCbCr 4:2:2", ...).
LinkColour link_colour_from(const std::string& setting);

}  // namespace prismesh::kiosk::display
