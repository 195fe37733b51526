// Finds and writes the cards of elements that are no shells: beams (*ELEMENT_BEAM) and solids (*ELEMENT_SOLID).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/cards.h"

namespace prismesh::mesh::deck::lsdyna {

/// As CardWriter::find_element.
Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id, std::span<const std::int64_t> nodes);
/// As CardWriter::element_like.
Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element);
/// As CardWriter::end_of_cards: the line with *END.
std::size_t end_of_cards(std::string_view text);
/// As CardWriter::new_element: a line of *ELEMENT_BEAM or *ELEMENT_SOLID in the columns that the file's *KEYWORD gives.
Result<WrittenCard> new_element(std::string_view text, ElementClass element_class, const ElementCard& element);

}  // namespace prismesh::mesh::deck::lsdyna
