// Writes and reads what an edit changed, as bytes: they turn a generation into the next one without applying the edit again.
// Layout: docs/journal.md. Private to mesh/document.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mesh/document/generation.h"

namespace prismesh::mesh::document {

/// Costs what differs. Precondition: `after` has all entries of `before` (removed ones too), and the same parts.
std::vector<std::byte> encode_delta(const Generation& before, const Generation& after);

/// Applies the delta to `generation`, a copy of the one before; returns the nodes that moved. Doesn't judge elements; after a topology
/// change the adjacency is null. Errors: anything out of range or out of order; `generation` is then partly changed and must be
/// discarded.
Result<NodeSet> apply_delta(std::span<const std::byte> delta, Generation& generation);

}  // namespace prismesh::mesh::document
