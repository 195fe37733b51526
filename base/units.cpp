#include "base/units.h"

namespace prismesh {

std::string_view name(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m: return "m";
    case LengthUnit::in: return "in";
    case LengthUnit::mm: break;
  }
  return "mm";
}

std::optional<LengthUnit> length_unit_from(std::string_view text) {
  for (const LengthUnit unit : {LengthUnit::mm, LengthUnit::m, LengthUnit::in})
    if (text == name(unit)) return unit;
  return std::nullopt;
}

double millimetres_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::m: return 1000.0;
    case LengthUnit::in: return 25.4;
    case LengthUnit::mm: break;
  }
  return 1.0;
}

}  // namespace prismesh
