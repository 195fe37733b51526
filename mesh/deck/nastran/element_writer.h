// Writes welds: CWELD and CFAST that name the properties of the sheets that they join.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::nastran {

/// As CardWriter::find_element, of CWELD and CFAST.
Result<deck::ElementPlace> find_element(const Deck& deck, ElementClass element_class, std::int64_t id);

/// As CardWriter::element_like. Whatever form the example has, the new weld is a CWELD of form PARTPAT or a CFAST of type PROP: the grid
/// points at its ends and the properties of the sheets. Sources: MSC Nastran Quick Reference Guide, CWELD and CFAST; Altair OptiStruct
/// Reference Guide, CWELD and CFAST.
Result<WrittenCard> weld_like(std::string_view text, std::size_t example, const ElementCard& element);

/// A CWELD of form PARTPAT in small fields.
Result<WrittenCard> new_weld(std::string_view text, const ElementCard& element);

/// Before the main bulk data's ENDDATA, or before a BEGIN of another section; else the text's end.
std::size_t end_of_bulk_data(std::string_view text);

}  // namespace prismesh::mesh::deck::nastran
