// Brings back what a journal's record did. Private to mesh/document.
#pragma once

#include <string>

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/journal_records.h"

namespace prismesh::mesh::document {

/// Does the record's step to the document as it was before it. `file` is for errors. Errors: the delta doesn't fit, there is no such step;
/// then the document is unchanged.
Result<void> take_record(const JournalRecord& record, Document& document, const std::string& file);

}  // namespace prismesh::mesh::document
