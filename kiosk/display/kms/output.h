// Chooses what of a graphics card shows the picture: monitor, mode, CRTC and plane.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/display/edid.h"
#include "kiosk/display/kms/card.h"

namespace prismesh::kiosk::display::kms {

/// What the settings ask for; empty: the panel's own.
struct WantedOutput {
  std::string connector;
  PixelSize size;
  double refresh_hz = 0;
};

struct Output {
  Connector connector;
  Mode mode;
  ObjectId crtc = 0;
  ObjectId plane = 0;
  std::optional<drivers::display::Edid> edid;
  PixelSize native;                ///< of the panel; 0: not known
  std::vector<std::string> notes;  ///< what a technician should know, a sentence each
};

/// The smallest picture that panels fit into.
inline constexpr PixelSize kMinPicture{320, 240};

/// Chooses. Without a wish: the first connected monitor and its native mode, which is what its EDID names, else what the card prefers, else
/// the largest. Errors, as sentences: no monitor; not the wanted one; no such mode (with the modes there are); a mode smaller than
/// kMinPicture; no plane that shows the picture.
Result<Output> choose_output(const CardState& card, const WantedOutput& wanted);

}  // namespace prismesh::kiosk::display::kms
