// Computes the size of the history and what to drop when it exceeds its cap. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Bytes of the chunks of `next` that `before` doesn't share. Costs a comparison a chunk.
std::size_t own_bytes(const Generation& before, const Generation& next);

/// How many of the oldest generations must be dropped so that the history, with `next` after the current one, keeps its cap.
std::size_t generations_over_cap(const Document& document, const Generation& next);

}  // namespace prismesh::mesh::document
