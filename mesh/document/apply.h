// Applies each kind of edit to a copy of the current generation. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"
#include "mesh/document/edit.h"
#include "mesh/document/edit_report.h"

namespace prismesh::mesh::document {

/// `next` starts as a copy of `document.current()`. Adds notes and figures to `report`, but not its counts before and after.
Result<void> apply_edit(const Document& document, const Select& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const SelectRegion& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SelectLasso& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SelectFlange& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Grow& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Shrink& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Invert& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SetParts& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SetTargetSize& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const SetCriteria& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Translate& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Lift& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Slide& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Rotate& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Move& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Relax& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Repair& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Restructure& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const Separate& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Weld& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const Bond& edit, Generation& next, EditReport& report, const Progress& progress);
Result<void> apply_edit(const Document& document, const RepairWelds& edit, Generation& next, EditReport& report);
Result<void> apply_edit(const Document& document, const ReplacePart& edit, Generation& next, EditReport& report, const Progress& progress);

/// Updates the weight of `next` for `shells`, which differ from `before`.
void update_weight(const Generation& before, const ShellSet& shells, Generation& next);

}  // namespace prismesh::mesh::document
