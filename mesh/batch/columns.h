// The figures of a variant, one list for the table, the page and the curves. Private to mesh/batch.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mesh/batch/table.h"

namespace prismesh::mesh::batch {

struct Column {
  std::string_view name;   ///< in CSV and JSON
  std::string_view words;  ///< on the page
  bool is_drawn = false;   ///< how it depends on the parameters is drawn
  bool is_length = false;  ///< in the deck's length unit
  std::optional<double> (*of)(const VariantResult& result);
  std::optional<double> (*before)(const VariantResult& result) =
      nullptr;  ///< the same of the deck as it was; null: there is no such figure
};
std::span<const Column> columns();
/// Absent: the variant isn't done, or the figure isn't known.
std::optional<double> figure_of(const Column& column, const Row& row);
std::optional<double> figure_before(const Column& column, const Row& row);

/// The deck of a variant that is done, from the folder of the results; else empty.
std::string written_file(const Row& row);

}  // namespace prismesh::mesh::batch
