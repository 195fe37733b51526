// Whether a shell of a patch may get other corners, and the order of these. Private to mesh/repair.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

/// Why an operation is impossible, as the end of a message; nothing: it was done.
using Refusal = std::optional<std::string_view>;
using Loop = std::vector<LocalNode>;  ///< nodes around an area

/// Why a shell can't be reshaped to as many corners; and why it can't be divided so that a piece has as many.
Refusal refuse_reshaping(const Patch& patch, LocalShell shell, std::size_t corners);
Refusal refuse_dividing(const Patch& patch, LocalShell shell, std::size_t corners);

/// A loop as corners, beginning with the edge whose direction is nearest to `direction`: material axes count from the first edge.
Corners corners_along(const Patch& patch, const Loop& loop, const Vec3& direction);
/// The unit direction of a shell's first edge; zero if it has no length.
Vec3 first_edge(const Patch& patch, LocalShell shell);

}  // namespace prismesh::mesh::repair
