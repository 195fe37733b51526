// Sets and tells the limits of relaxing and repairing.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"
#include "kiosk/tools/quality/mend_limits.h"

namespace prismesh::kiosk::tools::quality {

/// The limits after `text` was typed for one of them: a number, or nothing, which takes it away. Errors: a sentence (file and line empty).
Result<MendLimits> with_limit(const MendLimits& now, MendLimit which, std::string_view text);

/// The number as it is now, for its field; empty: none.
std::string typed_limit(const MendLimits& now, MendLimit which);

/// What is asked for, and what may be typed: "Relaxing moves a node within its sheet by at most".
std::string title_of(MendLimit which);
std::string hint_of(MendLimit which);

}  // namespace prismesh::kiosk::tools::quality
