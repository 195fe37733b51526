// What an edit changed, as bytes: enough to make the next generation out of the one before without running the edit again.
// Layout: docs/journal.md. Private to mesh/document.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Costs what differs. Precondition: `after` has all entries of `before` (removed ones too), and the same parts.
std::vector<std::byte> encode_delta(const Generation& before, const Generation& after);

/// Changes `generation` (a copy of the one before) as the delta says; returns the nodes that moved. Doesn't judge elements; after a
/// topology change the adjacency is null. Errors: anything out of range or out of order; then `generation` is half changed and to be thrown
/// away.
Result<NodeSet> apply_delta(std::span<const std::byte> delta, Generation& generation);

}  // namespace prismesh::mesh::document
