// Reads a table of points: comma-separated values with the columns x, y and z.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::connections {

inline constexpr std::size_t kMaxPointsOfTable = 1'000'000;

/// Commas, semicolons or tabs between the fields. The first line may name the columns in any order and case ("id,X,Y,Z"); without names the
/// first three are x, y and z. Empty lines and lines that begin with '#' are skipped. `file` is named in errors.
/// Errors, with the line: a field that is no finite number, a line without all three, too many points; no point at all; no column of a
/// name.
Result<std::vector<Vec3>> read_points(std::string_view text, const std::string& file);

}  // namespace prismesh::mesh::connections
