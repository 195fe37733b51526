// A monitor and the way pictures reach it, as far as a display server tells.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/display/edid.h"
#include "kiosk/display/window.h"

namespace prismesh::kiosk::display {

/// How colours travel from the graphics card to the panel.
enum class LinkColour : std::uint8_t { unknown, full, halved };  ///< halved: YCbCr 4:2:2 or 4:2:0

/// A monitor and the way pictures reach it. What can't be found out stays empty.
struct Monitor {
  std::string connector;  ///< "DP-1"
  std::optional<drivers::display::Edid> edid;
  int x = 0, y = 0;          ///< its upper left corner in the desktop's pixels
  PixelSize shown;           ///< pixels of the desktop that it shows
  PixelSize mode;            ///< pixels that are sent to it
  PixelSize native;          ///< pixels of the panel: its preferred mode
  double refresh_hz = 0;     ///< 0: unknown
  bool transformed = false;  ///< the graphics card resamples (scale, shear, "underscan")
  bool turned = false;       ///< rotated or mirrored on the way
  LinkColour colour = LinkColour::unknown;
};

/// The colour that a graphics driver's own setting for the connector names ("rgb", "ycbcr444", "YCbCr 4:2:2", ..).
LinkColour link_colour_from(const std::string& setting);

}  // namespace prismesh::kiosk::display
