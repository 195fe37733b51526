// The pieces into which a crossing curve cuts a sheet. Private to mesh/contact.
#pragma once

#include <vector>

#include "mesh/contact/perforations.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

/// Returns the nodes of the pieces that are cut off from side a's sheet (side b's if `of_a` is false), ascending: all pieces at the curve
/// but the one with the most nodes. Nodes exactly on the other sheet belong to no piece. Empty: the curve cuts nothing off. Costs no more
/// than what is cut off, times the number of pieces.
std::vector<NodeIndex> cut_off_nodes(const Model& model, const Perforation& perforation, bool of_a);

/// Both sides of the curve in one sheet.
struct CutPieces {
  std::vector<NodeIndex> cut_off;  ///< as above
  std::vector<NodeIndex> larger;   ///< the piece with the most nodes, ascending; empty if it is much larger than what is cut off
};
CutPieces cut_pieces(const Model& model, const Perforation& perforation, bool of_a);

}  // namespace prismesh::mesh::contact
