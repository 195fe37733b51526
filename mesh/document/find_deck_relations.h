// Finds the relations of a deck. Private to mesh/document.
#pragma once

#include <memory>

#include "mesh/deck/data/deck.h"
#include "mesh/document/deck_relations.h"

namespace prismesh::mesh::document {

/// `deck` has just been opened as `model`. Costs the model if anything may lie on shells.
std::shared_ptr<const DeckRelations> find_deck_relations(std::shared_ptr<const deck::Deck> deck, const Model& model);

}  // namespace prismesh::mesh::document
