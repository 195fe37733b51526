// Numbers that are typed for a tool: what may be typed, and what it means.
#pragma once

#include <string_view>

#include "base/error.h"
#include "kiosk/tools/shaping/shaping_options.h"

namespace prismesh::kiosk::tools::shaping {

/// What a tool makes of the text: a lift one number (along the arrow), a turn one (degrees); a slide and a move three (x y z in the deck's
/// axes), or one: so far the way that `pulled` goes. Errors: a sentence.
Result<Pull> typed_displacement(Under handle, std::string_view text, const Pull& pulled);

/// What may be typed, for a person: "x y z, or how far".
std::string_view typed_hint(Under handle);

}  // namespace prismesh::kiosk::tools::shaping
