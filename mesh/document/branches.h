// Branches: undone states that an edit took the place of, and the way back to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "mesh/document/document.h"
#include "mesh/document/edit.h"

namespace prismesh::mesh::document {

/// Memory that these states cost: what each doesn't share with the one before.
std::size_t bytes_of(std::span<const std::shared_ptr<const Generation>> states);

/// Whether an edit made now keeps what was undone as a branch: it changes more than the selection, or a branch leaves from it.
bool leaves_branch(const Document& document);

/// Takes what was undone out of the history, and keeps it as a branch if leaves_branch.
void put_newer_aside(Document& document);

/// Null if there is none of that number.
const Branch* find_branch(const Document& document, std::uint64_t number);

/// The branch's states become what redo leads to; what it led to before is put aside. Precondition: the branch leaves from the current
/// state.
void take_branch(Document& document, std::uint64_t number);

/// Drops the oldest branches, and all that then leave from nowhere.
void drop_branches(Document& document, std::size_t oldest);

/// The steps from the current state to any state of the history or its branches: undos, redos, branches taken. Errors: no such state.
Result<std::vector<Edit>> way_to(const Document& document, std::uint64_t generation);

}  // namespace prismesh::mesh::document
