// Finds what depends on nodes without sharing them. Private to mesh/document.
#pragma once

#include <span>

#include "mesh/deck/data/deck.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/dependents.h"

namespace prismesh::mesh::document {

/// `uses` as in DeckRelations. Costs the model if anything may lie on its shells.
Dependents find_dependents(const deck::Deck& deck, const Model& model, std::span<const ElementUse> uses);

}  // namespace prismesh::mesh::document
