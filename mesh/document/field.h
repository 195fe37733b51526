// A field: one number for each node or shell of a model, shown as colours and figures, such as displacement, distance from a surface or
// quality. Definitions: docs/comparing.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::document {

/// The range of a colour map. Values beyond `clear` keep their part's colour, values beyond `full` get the map's last colour. If
/// `full` < `clear`, small values are the worse ones.
struct FieldLimits {
  double clear = 0;
  double full = 1;
  bool operator==(const FieldLimits&) const = default;
};

/// Statistics of the values that are numbers.
struct FieldFigures {
  std::size_t measured = 0;
  double min = 0, mean = 0, max = 0;
  std::uint32_t min_at = 0, max_at = 0;  ///< index of the node or shell; of equal ones the first
};

struct Field {
  std::string title;          ///< "displacement", "warpage", ..
  std::string unit;           ///< "mm", "deg", ..; empty: a pure number
  bool on_nodes = true;       ///< else on shells
  std::vector<float> values;  ///< by NodeIndex or ShellIndex, removed ones included; NaN: no value
  FieldFigures figures;       ///< of the values before they were rounded to floats
  FieldLimits limits;         ///< suggested
  std::size_t new_nodes = 0;  ///< have a displacement, but aren't in the figures: a saved deck doesn't tell where they come from
};

/// The number of existing shells without a value, or with a corner without one. They keep their part's colour.
std::size_t shells_without_value(const Model& model, const Field& field);

}  // namespace prismesh::mesh::document
