// Finds the pairs of shells that cross.
#pragma once

#include <vector>

#include "base/progress.h"
#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// Two shells without a common node that cross.
struct ShellCrossing {
  ShellIndex a, b;                     ///< a < b
  std::vector<CurveSegment> segments;  ///< where; a segment along a side of shells is that of each pair of shells at the side
};

/// Returns all pairs that cross, ascending, on all cores; the same whatever their number. A quad counts as its two triangles. The sheets
/// pass through each other where the insides of two triangles cross (crossing_of), and along a side of one sheet that lies exactly in the
/// other: there the shells at the side must be on both sides of the other sheet. Sheets that only touch don't cross, nor does a sheet that
/// leaves another one after lying flat in it. Shells without area, and those with a corner that isn't finite, are left out. `among`: only
/// pairs of these shells (ascending; null: of all); costs these alone. `progress` is asked after some 65,000 shells; stopped, it returns
/// nothing. Precondition: the model has its adjacency; the tree is that of the model.
std::vector<ShellCrossing> find_shell_crossings(const Model& model, const spatial::BoxTree& tree, const ShellSet* among = nullptr,
                                                const Progress& progress = {});

/// The segments along which two shells without a common node cross; empty: they don't. The same rules.
std::vector<CurveSegment> crossing_segments(const Model& model, ShellIndex a, ShellIndex b);

}  // namespace prismesh::mesh::contact
