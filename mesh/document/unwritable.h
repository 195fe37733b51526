// Finds the changes that a deck's format can't write. Private to mesh/document.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesh/document/document.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::document {

/// What a repair must not do to a shell, because the deck couldn't be written.
struct FrozenShell {
  std::uint8_t rules = 0;  ///< repair::ShellRule bits
  std::string why;         ///< with the place in the deck
};

struct Frozen {
  std::map<ShellIndex, FrozenShell> shells;
  std::map<NodeIndex, std::string> nodes;  ///< that can't be removed, with the reasons
  int searches = 0;                        ///< of find_unwritable so far
};

/// Searches a change that can't be saved for what prevents it, and adds that to `frozen`; returns the number of finds. A find is a single
/// shell where that alone can't be written, with as few rules as forbid what was done to it; otherwise a group of shells and nodes that are
/// connected by common nodes. A shell that is found again, and everything from the third search on, must stay as it is, so that a few
/// searches are enough. Costs a few trials for each find, and each trial all changes of the structure since the deck was opened.
/// Errors: cancelled.
Result<std::size_t> find_unwritable(const Document& document, const Model& model, const repair::Restructuring& change, Frozen& frozen,
                                    const Progress& progress = {});

/// The rules, with the frozen entities added. `frozen` must outlive them.
repair::Rules with_frozen(const repair::Rules& rules, const Frozen& frozen);

/// How many shells were held back, and the first reason; one sentence for those that had to stay as they were, and one for the others.
std::vector<std::string> notes_of(const Frozen& frozen);

}  // namespace prismesh::mesh::document
