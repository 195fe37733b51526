// The cards of a part of spot welds (*PART, *SECTION_BEAM, *MAT_SPOTWELD, *SET_PART_LIST and *CONTACT_SPOTWELD) and of a part of adhesive
// (*PART, *SECTION_SOLID, *MAT_ELASTIC, *SET_PART_LIST and *CONTACT_TIED_NODES_TO_SURFACE_OFFSET).
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

/// As CardWriter::bond_part, with numbers and columns as above. The section has ELFORM -1, which is for hexahedra that are thinner than
/// wide; the contact ties the nodes of the part to the sheets where they are, half a thickness beside the middle surface: without OFFSET it
/// would move them onto that. Source: LS-DYNA keyword manual, volume I, *SECTION_SOLID and *CONTACT; volume II, *MAT_ELASTIC.
Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const CardWriter::BondPart& wanted);

}  // namespace prismesh::mesh::deck::lsdyna
