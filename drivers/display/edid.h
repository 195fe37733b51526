// What a monitor says of itself: EDID (VESA E-EDID 1.4, with the CTA-861 extension). A codec: bytes in, facts out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"

namespace prismesh::drivers::display {

/// Who a monitor is, as far as it says: what a calibration is bound to.
struct MonitorIdentity {
  std::string maker;   ///< three letters: "EIZ"
  std::string model;   ///< its name, or the product code as four hexadecimal digits where it has none
  std::string serial;  ///< text or number; empty where it has none
  bool operator==(const MonitorIdentity&) const = default;
  /// "EIZ CG2420 12345": one line, no more than single blanks; empty for a monitor that says nothing.
  std::string text() const;
};

struct Edid {
  MonitorIdentity identity;
  int native_width = 0;  ///< pixels, of the preferred timing; 0: none is given
  int native_height = 0;
  double width_mm = 0;  ///< of the picture; 0: not given (projectors)
  double height_mm = 0;
  bool digital = false;
  bool takes_ycbcr_444 = false;
  bool takes_ycbcr_422 = false;  ///< a graphics driver may choose it for such a monitor: half of the colour columns are lost
};

/// Errors: too short, no EDID header, a wrong checksum of the first block. A damaged extension is left out.
Result<Edid> decode_edid(std::span<const std::byte> bytes);

}  // namespace prismesh::drivers::display
