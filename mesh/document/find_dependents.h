// Finds what depends on nodes without sharing them. Private to mesh/document.
#pragma once

#include <span>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/dependents.h"

namespace prismesh::mesh::document {

/// `uses` as in DeckRelations. Costs the model if anything may lie on its shells.
Dependents find_dependents(const deck::Deck& deck, const Model& model, std::span<const ElementUse> uses);

/// Adds nodes that lie on sheets, ascending by node; of a node that is there already the first entry stays.
void add_on_sheets(std::vector<NodeOnSheet> more, Dependents& dependents);

}  // namespace prismesh::mesh::document
