// Finds lines that tell what a shaping edit will do, so that a view can show them before it is made.
#pragma once

#include <array>
#include <vector>

#include "base/error.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

struct PullLines {
  /// Free edges that move by the whole displacement, by their ends: the lower node first, ascending.
  std::vector<std::array<NodeIndex, 2>> followed;
  /// Where the weight falls through a half, as pieces across shells. Deck coordinates, before the edit.
  std::vector<std::array<Vec3, 2>> halfway;
};

/// The edit's displacement is ignored. Errors: as applying it.
Result<PullLines> find_pull_lines(const Generation& generation, const Edit& edit);

}  // namespace prismesh::mesh::document
