// What an edit did, in one line: "Turned 10°: 12 nodes, at most 1.3 mm; fail 2 → 2; mass +0.8 %".
#pragma once

#include <string>
#include <string_view>

#include "mesh/document/edit.h"
#include "mesh/document/edit_report.h"

namespace prismesh::kiosk::link {

/// "Turned 10°", "Lifted 12.4 mm", "Repaired"; empty: the edit changes neither shape nor mesh. `unit`: of lengths.
std::string words_of_edit(const mesh::document::Edit& edit, std::string_view unit);

/// `what`: words_of_edit. Empty for an edit that has none and is no undo or redo.
std::string result_words(const std::string& what, const mesh::document::EditReport& report, std::string_view unit);

}  // namespace prismesh::kiosk::link
