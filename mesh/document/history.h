// What the history costs and what goes when it gets too large. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Bytes of the chunks of `next` that `before` doesn't share. Costs a comparison a chunk.
std::size_t own_bytes(const Generation& before, const Generation& next);

/// How many of the oldest generations must go for the history (with `next` after the current one) to keep its cap.
std::size_t generations_over_cap(const Document& document, const Generation& next);

}  // namespace prismesh::mesh::document
