// The places at which an edit wants welds. Private to mesh/document.
#pragma once

#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

/// Places of one line or flange; the sheets there.
struct WeldLine {
  std::vector<Vec3> places;
  std::vector<PartIndex> parts;                         ///< only sheets of these count, ascending; empty: all
  std::vector<std::array<std::vector<Vec3>, 2>> sides;  ///< of a flange (one entry): its two sides
  std::string note{};                                   ///< for the report
};

/// Errors: a field is missing or doesn't fit (no pitch, a pitch or end distance longer than the flange, a flange without width, no flange),
/// an expression, the table of points (file and line); cancelled.
Result<std::vector<WeldLine>> weld_places(const Document& document, const Weld& edit, const Progress& progress);

/// The edit with the points of its table instead of the table's name.
Result<Weld> with_points(const Document& document, const Weld& edit);

}  // namespace prismesh::mesh::document
