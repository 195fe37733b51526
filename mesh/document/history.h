// The document with a further generation; the size of the history, and what to drop when it exceeds its cap.
#pragma once

#include <memory>

#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Bytes of the chunks of `next` that `before` doesn't share. Costs a comparison a chunk.
std::size_t own_bytes(const Generation& before, const Generation& next);

/// What must be dropped, the oldest first.
struct HistoryExcess {
  std::size_t branches = 0;  ///< of `branches`; those that hang on them go too
  std::size_t generations = 0;
};
/// What must be dropped so that the history, with `next` after the current one, keeps its cap: branches first.
HistoryExcess excess_with(const Document& document, const Generation& next);

/// The document with a further generation as its current one.
Document with_current(const Document& document, std::shared_ptr<const Generation> generation);

}  // namespace prismesh::mesh::document
