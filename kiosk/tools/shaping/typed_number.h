// Numbers that are typed for a tool: what may be typed, and what it means.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "kiosk/tools/shaping/shaping_options.h"

namespace prismesh::kiosk::tools::shaping {

/// What a tool makes of the text: a lift one number (along the arrow), a turn one (degrees); a slide and a move three (x y z in the deck's
/// axes), or one: so far the way that `pulled` goes. Errors: a sentence.
Result<Pull> typed_displacement(input::Under handle, std::string_view text, const Pull& pulled);

/// What may be typed and where it goes, for a person: "x y z, or how far along 0 0.6 0.8". `along`: the arrow, the axis of a turn, the way
/// of the last slide or move; nothing: a lift along each node's own normal, or a slide or move that one number isn't enough for.
std::string typed_hint(input::Under handle, const std::optional<Vec3>& along);

}  // namespace prismesh::kiosk::tools::shaping
