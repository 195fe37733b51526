// Which of many changes a deck's format can't write. Private to mesh/document.
#pragma once

#include <map>
#include <string>

#include "mesh/document/document.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::document {

/// What must be left as it is, and why.
struct Frozen {
  std::map<ShellIndex, std::string> shells;
  std::map<NodeIndex, std::string> nodes;  ///< that can't be removed
};

/// Of a change that can't be saved as a whole: the groups of shells and nodes, each connected by common nodes, that can't be saved on their
/// own either. Costs a few trials for each, and each trial what the structure has changed since the deck was opened. Adds them to `frozen`;
/// returns how many groups it found. Errors: cancelled.
Result<std::size_t> find_unwritable(const Document& document, const Model& model, const repair::Restructuring& change, Frozen& frozen,
                                    const Progress& progress = {});

/// The rules, and that what is frozen stays. `frozen` must outlive them.
repair::Rules with_frozen(const repair::Rules& rules, const Frozen& frozen);

}  // namespace prismesh::mesh::document
