// Finds the card of an element that is no shell.
#pragma once

#include <cstdint>
#include <string>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck {

/// `element`: index in its class. Costs a search through the text of the deck's files. Errors: it can't be found, stands in an include that
/// is used twice or whose ids are shifted in an unknown way, or can't be an example; with the reason.
Result<ElementPlace> place_of_element(const Deck& deck, const Model& model, const CardWriter& writer, ElementClass element_class,
                                      std::uint32_t element);

/// "beam 7"
std::string element_name(const Model& model, ElementClass element_class, std::uint32_t element);

}  // namespace prismesh::mesh::deck
