// Lists which file of a deck holds which parts, so that views can hide and lock by file.
#pragma once

#include <vector>

#include "ipc/model/messages.h"
#include "mesh/document/document.h"

namespace prismesh::modeld {

/// Returns the deck's files that hold shells, in the deck's order. Cost: one pass over the shells.
std::vector<ipc::DeckFile> files_with_shells(const mesh::document::Document& document);

}  // namespace prismesh::modeld
