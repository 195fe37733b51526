// Computes how far perforations go through.
#pragma once

#include <span>
#include <vector>

#include "mesh/contact/perforations.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// Returns the depth of each perforation, on all cores; the same whatever their number. The curve cuts each sheet; a sheet is all shells
/// that are connected over shared nodes. The pieces that it cuts off enter; where both sheets are cut, those with the smaller area. The
/// depth is the greatest distance of an entering node from the other part's shells; in folds of one part, from the shells that cross. A
/// curve that cuts nothing off is half through: its depth isn't known. `thickness_share` of the thicknesses of both shells is added: 0.5 to
/// separate their faces, 0 for their middle surfaces. Costs what is cut off, and the other
/// part's shells about it. Preconditions: the model has its adjacency; the tree is that of the model.
std::vector<PerforationDepth> perforation_depths(const Model& model, const spatial::BoxTree& tree,
                                                 std::span<const Perforation> perforations, double thickness_share);

/// A piece of one side that could be pushed back through the other side.
struct EnteringPiece {
  PerforationDepth depth;
  bool is_larger = false;  ///< the other piece of its sheet has fewer nodes
};
/// Returns what the curve cuts off from each side, side a's first; then the larger pieces that go less deep than what is cut off from
/// their sheet. Empty: half through. Costs as much as the depth. Preconditions as above.
std::vector<EnteringPiece> entering_pieces(const Model& model, const spatial::BoxTree& tree, const Perforation& perforation);

}  // namespace prismesh::mesh::contact
