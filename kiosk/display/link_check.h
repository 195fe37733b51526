// Whether a woven picture reaches the panel's pixels unchanged: one pixel of the picture on one pixel of the panel, each with its own
// colour. Anything between that scales, turns or halves colours mixes the eyes, so such a mode or link is refused for it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/display/profile.h"
#include "kiosk/display/monitor.h"

namespace prismesh::kiosk::display {

struct LinkReport {
  /// Why this profile can't be shown in stereo here, each a sentence that says what to change; empty: nothing speaks against it.
  std::vector<std::string> refusals;
  /// What couldn't be found out and has to be looked at.
  std::vector<std::string> doubts;
  bool stereo_allowed() const { return refusals.empty(); }
};

/// `monitor` empty: nothing is known (headless, a display without RandR); that is a doubt, no refusal. A profile that is no weave of
/// pixels (anaglyph, one eye) has nothing to lose and passes.
LinkReport check_link(const drivers::display::Profile& profile, const std::optional<Monitor>& monitor);

}  // namespace prismesh::kiosk::display
