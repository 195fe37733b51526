// Writes the cards of elements that are no shells: like an existing one, or in a block of their own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::abaqus {

/// As CardWriter::find_element, of solids with eight nodes and of connectors (CONN3D2). Refused as well: decks of parts and instances,
/// where numbers aren't unique; an element that a surface names by its number; a connector that no *FASTENER attaches.
Result<ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id, std::span<const std::int64_t> nodes);

/// As CardWriter::element_like.
Result<WrittenCard> element_like(std::string_view text, const ElementPlace& example, const ElementCard& element);

/// Before the first *STEP: all that isn't history stands above it.
std::size_t end_of_model(std::string_view text);

/// As CardWriter::element_header and new_element. Solids are C3D8, the hexahedron that Abaqus/Standard, Abaqus/Explicit and CalculiX have;
/// welds are CONN3D2.
Result<std::string> element_header(ElementClass element_class, const Part& part);
WrittenCard new_element(const ElementCard& element);

/// A name as a keyword's parameter or a data line has it: in quotes where it needs them.
std::string quoted_name(const std::string& name);

/// Whether a file has *PART or *INSTANCE.
bool has_instances(const Deck& deck);

}  // namespace prismesh::mesh::deck::abaqus
