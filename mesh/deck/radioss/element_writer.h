// Finds and writes the cards of elements that are no shells: springs (/SPRING).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "base/error.h"
#include "mesh/deck/data/deck.h"
#include "mesh/deck/writing/cards.h"

namespace prismesh::mesh::deck::radioss {

/// As CardWriter::find_element.
Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id, std::span<const std::int64_t> nodes);
/// As CardWriter::element_like: in the block of the example, and so of its part.
Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element);

}  // namespace prismesh::mesh::deck::radioss
