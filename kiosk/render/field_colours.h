// A field's values and its colour map on the GPU, for one view of the model.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "kiosk/render/colour_map.h"
#include "kiosk/render/model_table.h"
#include "kiosk/render/row_texture.h"

namespace prismesh::kiosk::render {

/// How values become colours. Beyond `clear` they keep the part's own; from `full` on they have the map's last.
struct FieldLook {
  bool on = false;
  double clear = 0;
  double full = 1;  ///< differs from `clear`; smaller where small values are the worse ones
  ColourMap map = ColourMap::crimson;
  int bands = 0;  ///< so many even colours instead of a gradient; 0: a gradient
  bool operator==(const FieldLook&) const = default;

  /// The map's colour of a value; nothing for one that keeps its own.
  std::optional<Colour> colour_of(double value) const;
};

class FieldColours {
 public:
  FieldColours();

  /// By node or by shell; NaN: no value. Uploads the rows that differ from the last ones. Errors: no graphics memory.
  Result<void> set(std::span<const float> values, bool on_nodes);
  void clear() { shown_ = 0; }
  /// What the shells' shader is told: 0 nothing, 1 values of nodes, 2 of shells. Values of another model's size aren't shown.
  int kind_for(const ModelTable& table) const;
  void bind(unsigned values_unit, unsigned map_unit, const FieldLook& look);
  std::size_t bytes_uploaded() const { return values_.bytes_uploaded(); }

 private:
  RowTexture values_;
  std::vector<float> known_;  ///< what the texture holds
  std::size_t shown_ = 0;     ///< values; 0: none
  bool on_nodes_ = true;
  gl::Texture map_;
  std::optional<ColourMap> map_is_;
};

}  // namespace prismesh::kiosk::render
