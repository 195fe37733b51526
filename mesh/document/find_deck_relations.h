// Finds what a deck says besides its shells. Private to mesh/document.
#pragma once

#include <memory>

#include "mesh/deck/data/deck.h"
#include "mesh/document/deck_relations.h"

namespace prismesh::mesh::document {

/// Of a deck just opened and its model. Costs the model where something may lie on shells.
std::shared_ptr<const DeckRelations> find_deck_relations(std::shared_ptr<const deck::Deck> deck, const Model& model);

}  // namespace prismesh::mesh::document
