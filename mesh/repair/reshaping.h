// Whether a shell of a patch may be given other corners, and in which order they stand. Inner to repair.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

/// Why an operation is impossible, as the end of a sentence; nothing: it was done.
using Refusal = std::optional<std::string_view>;
using Loop = std::vector<LocalNode>;

/// Why a shell can't be given as many other corners; or be divided, so that one of the pieces has as many.
Refusal refuse_reshaping(const Patch& patch, LocalShell shell, std::size_t corners);
Refusal refuse_dividing(const Patch& patch, LocalShell shell, std::size_t corners);

/// A loop as corners, beginning where its edge runs most along `direction`: material axes count from the first edge.
Corners turned_like(const Patch& patch, const Loop& loop, const Vec3& direction);
/// The direction of a shell's first edge.
Vec3 first_edge(const Patch& patch, LocalShell shell);

}  // namespace prismesh::mesh::repair
