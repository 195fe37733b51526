// Edits that need nothing but the document any more.
#pragma once

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

/// The same edit with the content of the file that it names (SetCriteria::text), and the file's whole path. What goes into a journal is
/// made of this. Errors: those of the file and of an edit that is wrong.
Result<Edit> self_contained(const Document& document, const Edit& edit);

}  // namespace prismesh::mesh::document
