// Length units of decks. A deck doesn't declare its unit; the document's settings do.
#pragma once

#include <optional>
#include <string_view>

namespace prismesh {

enum class LengthUnit { mm, m, in };

std::string_view name(LengthUnit unit);
std::optional<LengthUnit> length_unit_from(std::string_view name);
double millimetres_per(LengthUnit unit);

}  // namespace prismesh
