// What an edit would do, told without doing it.
#pragma once

#include "base/clock.h"
#include "base/error.h"
#include "ipc/messages.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// Works the edit out and says what the next generation would have otherwise. Errors: those of the edit.
Result<ipc::EditPreviewed> preview_edit(const mesh::document::Document& document, const mesh::document::Edit& edit, Clock* clock = nullptr);

}  // namespace prismesh::modeld
