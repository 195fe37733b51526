// Warns of oddities of a deck as a whole, in any format: ids that cards name and nothing defines, parts and nodes that nothing uses, unread
// text.
#pragma once

#include "mesh/deck/assembly/warnings.h"
#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

/// Adds warnings of these kinds: "names-undefined-node" (-shell, ..., -element, -part, -set), "empty-range", "undefined-part" (of
/// elements), "unused-part", "unused-node", "unread-card", "encrypted". The deck's references must be finished, the model's adjacency
/// built. Linear in the model and the references.
void note_findings(const Deck& deck, const Model& model, Warnings& warnings);

}  // namespace prismesh::mesh::deck
