// Finds flanges: bands along which two or more sheets run parallel at a small distance. Rules: docs/connections.md.
#pragma once

#include "base/progress.h"
#include "mesh/connections/flange.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

/// Finds the flanges of the visible shells.
///
/// Method. 1. The stack at a shell: the line through its centre along its normal hits other shells, of other parts or folds of its own
/// part, without a common node. From the shell up and down the stack goes on as long as the next hit is within the distance that the
/// options allow and the planes there within 15 degrees; it has at most kMaxSheets. 2. Growth: shells that share an edge, with an angle up
/// to 30 degrees, and have the same stack in the same order are of one band, and so are a shell and those in its stack that have the
/// same one. So a flange has the same parts all along; where another sheet joins it, another flange begins. 3. Shape: of the sheet with
/// the clearest border (free edges and creases, where the others end somewhere below) the border is divided into two sides and two ends.
/// A strip of length L and width w has the border 2(L + w) and the area Lw, straight or curved, which gives w; the ends are where
/// the distances of points at equal shares of both sides differ least from w. The middle curve is that of these pairs. A ring has a border
/// for each side.
///
/// Not flanges: bands wider than the options allow (a plate that lies on a plate), shorter than 1.5 widths or three shells, and bands
/// whose sheets go through each other along more than a quarter of the length. A band that branches is one flange, whose curve
/// follows two of the branches.
///
/// Widths are exact where the sheet with the clearest border is; where a band's border lies within shells, to half a shell.
/// Returns the same on any number of cores; nothing if `progress` stops it. Costs the shells with a search of some around each.
/// Preconditions: the model has its adjacency; the tree is that of the model; the options' lengths are finite, at least 0.
Flanges find_flanges(const Model& model, const spatial::BoxTree& tree, const FlangeOptions& options = {}, const Progress& progress = {});

}  // namespace prismesh::mesh::connections
