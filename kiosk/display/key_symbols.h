// Keys by the symbols that X11 and xkbcommon share.
#pragma once

#include <cstdint>

#include "kiosk/display/window.h"

namespace prismesh::kiosk::display {

/// `symbol`: of X11's keysymdef.h, the key's without modifiers.
Key key_from_symbol(std::uint32_t symbol);

}  // namespace prismesh::kiosk::display
