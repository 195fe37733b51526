// One number for each node or shell of a model, to be seen as colour and told as figures: how far it has moved, how far it lies from a
// surface, how good it is. Definitions: docs/comparing.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh::document {

/// Where a colour map begins and ends. What lies beyond `clear` keeps its own colour, what lies beyond `full` has the map's last one.
/// `full` < `clear`: small values are the worse ones.
struct FieldLimits {
  double clear = 0;
  double full = 1;
  bool operator==(const FieldLimits&) const = default;
};

/// Of the values that are numbers.
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
  std::size_t new_nodes = 0;  ///< have a value in a displacement, but count in no figure: a saved deck doesn't know where they come from
};

/// Shells that are there, but have no value of their own or at one of their corners: they keep their colour whatever the limits.
std::size_t shells_without_value(const Model& model, const Field& field);

}  // namespace prismesh::mesh::document
