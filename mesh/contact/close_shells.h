// Finds the pairs of shells that are too close to each other.
#pragma once

#include <vector>

#include "base/progress.h"
#include "mesh/contact/closeness.h"
#include "mesh/contact/contact_thickness.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// Returns all pairs of shells without a common node that are too close, ascending, on all cores; the same whatever their number. A quad
/// counts as its two triangles. Left out: shells without a thickness or an area, triangles with a corner that isn't finite; pairs beside
/// each other, of which neither faces the other and the planes are alike, as at a seam; neighbours in a sheet. Shells that cross are too
/// close, too. The distance is that of points and triangles both ways and of edges, in doubles from the corners' differences: right to some
/// 1e-15 of the shells' size, but for triangles whose height is below 1e-8 of their length. `among`: only pairs of these shells (ascending;
/// null: of all); costs these alone. Preconditions: the model has its adjacency; the tree is that of the model; the gap is finite, at
/// least 0. `progress` is asked after some 65,000 shells; stopped, it returns nothing.
std::vector<CloseShells> find_close_shells(const Model& model, const spatial::BoxTree& tree, const ContactThickness& thickness, double gap,
                                           const ShellSet* among = nullptr, const Progress& progress = {});

}  // namespace prismesh::mesh::contact
