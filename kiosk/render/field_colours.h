// Keeps a field's values and its colour map on the GPU, for one view of the model.
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

/// How values are coloured. Values up to `clear` keep the part's colour; from there the map runs to its last colour at `full`.
struct FieldLook {
  bool on = false;
  double clear = 0;
  double full = 1;  ///< differs from `clear`; smaller than it if small values are worse
  ColourMap map = ColourMap::crimson;
  int bands = 0;  ///< number of even colours; 0: a gradient
  bool operator==(const FieldLook&) const = default;

  /// The colour of a value; empty if it keeps the part's.
  std::optional<Colour> colour_of(double value) const;
};

class FieldColours {
 public:
  FieldColours();

  /// Sets the values, one for each node or shell; NaN: no value. Uploads only the rows that changed. Errors: no graphics memory.
  Result<void> set(std::span<const float> values, bool on_nodes);
  void clear() { shown_ = 0; }
  /// Uniform `field_kind` of the shell shader: 0 none, 1 values of nodes, 2 of shells. 0 if the number of values doesn't fit the model.
  int kind_for(const ModelTable& table) const;
  void bind(unsigned values_unit, unsigned map_unit, const FieldLook& look);
  /// Bytes on the graphics card for so many values.
  static std::size_t bytes_for(std::size_t values);
  std::size_t bytes_held() const { return values_.bytes_held() + (map_ ? kColourMapSteps * 4 : 0); }
  std::size_t bytes_uploaded() const { return values_.bytes_uploaded(); }

 private:
  RowTexture values_;
  std::vector<float> known_;  ///< content of the texture
  std::size_t shown_ = 0;     ///< number of values; 0: none
  bool on_nodes_ = true;
  gl::Texture map_;
  std::optional<ColourMap> map_shown_;
};

}  // namespace prismesh::kiosk::render
