// Finds the changes that a deck's format can't write. Private to mesh/document.
#pragma once

#include <map>
#include <string>

#include "mesh/document/document.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::document {

/// Entities that must not be changed, with the reasons.
struct Frozen {
  std::map<ShellIndex, std::string> shells;
  std::map<NodeIndex, std::string> nodes;  ///< that can't be removed
};

/// Splits a change that can't be saved into groups of shells and nodes that are connected by common nodes, and adds the groups that can't
/// be saved on their own to `frozen`; returns their number. Costs a few trials for each, and each trial all changes of the structure since
/// the deck was opened. Errors: cancelled.
Result<std::size_t> find_unwritable(const Document& document, const Model& model, const repair::Restructuring& change, Frozen& frozen,
                                    const Progress& progress = {});

/// The rules, with the frozen entities added. `frozen` must outlive them.
repair::Rules with_frozen(const repair::Rules& rules, const Frozen& frozen);

}  // namespace prismesh::mesh::document
