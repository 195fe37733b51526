// The choice of a field, and its name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/quality/metrics.h"

namespace prismesh::mesh::document {

/// The choice of a field.
struct FieldWish {
  enum class Of : std::uint8_t { displacement, surface_distance, gap, metric, composite, time_step };
  Of of = Of::displacement;
  quality::Metric metric = quality::Metric::warpage;
  std::string from, to;  ///< of a gap: expressions
};

/// "displacement", "distance-to-original", "distance", "metric:NAME", "composite", "time-step". Errors: there is no such field; names the
/// nearest.
Result<FieldWish> field_wish(std::string_view name);
std::string name(const FieldWish& wish);
/// Whether the field compares with another state.
inline bool needs_other(const FieldWish& wish) {
  return wish.of == FieldWish::Of::displacement || wish.of == FieldWish::Of::surface_distance;
}

}  // namespace prismesh::mesh::document
