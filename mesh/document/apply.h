// The edits themselves: each turns a copy of the current generation into the next one. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/document/edit_report.h"

namespace prismesh::mesh::document {

/// `next` starts as a copy of `document.current()`. Notes and figures go to `report`; counts before and after don't.
Result<void> apply_edit(const Document& document, const Select& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const SelectRegion& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SelectLasso& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Grow& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Shrink& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Invert& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SetParts& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Translate& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Lift& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Slide& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Rotate& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Relax& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Repair& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Restructure& edit, Generation& next, EditReport& report);

/// Brings the weight of `next` up to date after the shells given have changed since `before`.
void update_weight(const Generation& before, const ShellSet& shells, Generation& next);

}  // namespace prismesh::mesh::document
