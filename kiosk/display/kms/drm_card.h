// A real graphics card, through libdrm.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "kiosk/display/kms/card.h"

namespace prismesh::kiosk::display::kms {

/// Takes over a card whose file is open; `descriptor` stays the caller's and must live longer. `name`: "/dev/dri/card0", for errors.
/// Errors: not a card that shows pictures; a driver without atomic mode setting.
Result<std::unique_ptr<Card>> make_drm_card(int descriptor, std::string name);

}  // namespace prismesh::kiosk::display::kms
