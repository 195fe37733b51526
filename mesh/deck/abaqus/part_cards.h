// The cards of a part of adhesive (*MATERIAL, *SOLID SECTION, and two *TIE with their *SURFACEs) and of a part of spot welds (*CONNECTOR
// SECTION, *FASTENER PROPERTY, *SURFACE and *FASTENER).
#pragma once

#include <string>
#include <utility>

#include "base/error.h"
#include "mesh/deck/writing/card_writer.h"

namespace prismesh::mesh::deck::abaqus {

/// As CardWriter::bond_part. The first four corners of the hexahedra are tied to the sheets by one *TIE, the other four by another one: the
/// solver takes the nearest face of a main surface, and CalculiX finds none where a surface has both sides of a shell. ADJUST=NO leaves the
/// nodes where they are. Source: Abaqus Keywords Reference Guide, *TIE, *SURFACE; Abaqus Analysis User's Guide, "Mesh tie constraints".
Result<std::pair<Part, std::string>> bond_part(const Deck& deck, const Model& model, const CardWriter::BondPart& wanted);

/// As CardWriter::weld_part. The connectors are rigid (BEAM) and have no mass; the fastener attaches their nodes to the shells of the
/// sheets within half the diameter. Source: Abaqus Keywords Reference Guide, *FASTENER, *FASTENER PROPERTY and *CONNECTOR SECTION; Abaqus
/// Analysis User's Guide, "Mesh-independent fasteners".
Result<std::pair<Part, std::string>> weld_part(const Deck& deck, const Model& model, const CardWriter::WeldPart& wanted);

}  // namespace prismesh::mesh::deck::abaqus
