// What follows from the other parts of a deck.
#pragma once

#include <span>
#include <vector>

#include "base/hash.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// One hash over all files: their bytes' hashes and their names relative to the main file.
Hash128 content_hash(std::span<const SourceFile> files, std::span<const Hash128> hashes);

/// The largest ids of each file's nodes and shells: Deck::last_ids.
std::vector<LastIds> last_ids_of(const Deck& deck, const Model& model);

}  // namespace prismesh::mesh::deck
