// Checks whether a woven picture reaches the panel's pixels unchanged: each pixel of the picture on one pixel of the panel, with its own
// colour. A mode or link that scales, turns, or transmits colours at half width mixes the eyes' pictures, so it is refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/display/profile.h"
#include "kiosk/display/monitor.h"

namespace prismesh::kiosk::display {

struct LinkReport {
  /// Why this profile can't be shown in stereo here. Each is a sentence that says what to change. Empty: stereo is allowed.
  std::vector<std::string> refusals;
  /// What couldn't be determined and must be checked by eye.
  std::vector<std::string> doubts;
  bool stereo_allowed() const { return refusals.empty(); }
};

/// Checks a profile on a monitor. `monitor` empty: unknown (headless, a display without RandR), which is a doubt, not a refusal. A profile
/// that doesn't weave pixels (anaglyph, one eye) always passes.
LinkReport check_link(const drivers::display::Profile& profile, const std::optional<Monitor>& monitor);

}  // namespace prismesh::kiosk::display
