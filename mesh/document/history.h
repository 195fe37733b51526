// The document with a further generation; the size of the history, and what to drop when it exceeds its cap. Private to mesh/document.
#pragma once

#include <memory>

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Bytes of the chunks of `next` that `before` doesn't share. Costs a comparison a chunk.
std::size_t own_bytes(const Generation& before, const Generation& next);

/// How many of the oldest generations must be dropped so that the history, with `next` after the current one, keeps its cap.
std::size_t generations_over_cap(const Document& document, const Generation& next);

/// The document with a further generation as its current one.
Document with_current(const Document& document, std::shared_ptr<const Generation> generation);

}  // namespace prismesh::mesh::document
