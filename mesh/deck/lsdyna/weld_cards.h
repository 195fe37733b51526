// The cards of a part of spot welds: *PART, *SECTION_BEAM, *MAT_SPOTWELD, *SET_PART_LIST and *CONTACT_SPOTWELD.
#pragma once

#include <string>
#include <utility>

#include "base/error.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::lsdyna {

/// As CardWriter::weld_part. One number, above all parts, sections, materials and sets of parts of the deck, is that of all four. The
/// section has ELFORM 9 and is a tube without a hole (CST 1); the contact ties the nodes of the part to the sheets. The columns are those
/// of the main file. Source: LS-DYNA keyword manual, volume I, *SECTION_BEAM and *CONTACT; volume II, *MAT_SPOTWELD.
Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const CardWriter::WeldPart& wanted);

}  // namespace prismesh::mesh::deck::lsdyna
