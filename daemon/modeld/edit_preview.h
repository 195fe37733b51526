// Previews an edit without applying it.
#pragma once

#include "base/clock.h"
#include "base/error.h"
#include "ipc/model/messages.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// Prepares the edit and returns what the next generation would change: moved nodes and the shells they touch, before and after. Errors:
/// of the edit.
Result<ipc::EditPreviewed> preview_edit(const mesh::document::Document& document, const mesh::document::Edit& edit, Clock* clock = nullptr);

}  // namespace prismesh::modeld
