// What the user has chosen for a part in the picture. No edit: it belongs to one kiosk and changes nothing in the model.
#pragma once

#include <optional>

#include "kiosk/render/palette.h"

namespace prismesh::kiosk::render {

struct PartPaint {
  std::optional<Colour> colour{};  ///< instead of the part's own; only while parts have their own colours
  bool transparent = false;        ///< seen through, and not picked
  bool operator==(const PartPaint&) const = default;
};

}  // namespace prismesh::kiosk::render
