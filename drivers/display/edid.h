// Decodes a monitor's description of itself: EDID (VESA E-EDID 1.4, with the CTA-861 extension).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"

namespace prismesh::drivers::display {

/// Identifies a monitor as far as its EDID does. A calibration is bound to this identity.
struct MonitorIdentity {
  std::string maker;   ///< three letters, for example "EIZ"
  std::string model;   ///< the monitor's name, or else its product code as four hexadecimal digits
  std::string serial;  ///< text or number; empty if none is given
  bool operator==(const MonitorIdentity&) const = default;
  /// Returns one line such as "EIZ CG2420 12345", with single blanks; empty if all parts are empty.
  std::string text() const;
};

struct Edid {
  MonitorIdentity identity;
  int native_width = 0;  ///< pixels of the preferred timing; 0 if none is given
  int native_height = 0;
  double width_mm = 0;  ///< size of the picture; 0 if not given (projectors)
  double height_mm = 0;
  bool digital = false;
  bool takes_ycbcr_444 = false;
  /// A graphics driver may choose this format for such a monitor, which halves the horizontal colour resolution.
  bool takes_ycbcr_422 = false;
};

/// Decodes an EDID. Skips a damaged extension block. Errors: too short; no EDID header; wrong checksum of the first block.
Result<Edid> decode_edid(std::span<const std::byte> bytes);

}  // namespace prismesh::drivers::display
