// Selects along the surface: regions of shells, rings of neighbours. Shells of hidden parts count as missing.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/connections/joined_sheets.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::select {

/// Where a region ends. features: at creases and fillets that bend by more than the angle, free edges and junctions of three or more
/// shells; creases: the same, but each edge counts by itself, so that the region continues over a fillet whose single edges bend less;
/// part: at the end of its part; piece: where no shared edge connects further shells.
enum class RegionBound : std::uint8_t { features, creases, part, piece };

struct RegionOptions {
  RegionBound bound = RegionBound::features;
  double angle_degrees = 30;  ///< for the bounds features and creases; 180: nothing bends by more
  OutOfSight out_of_sight;    ///< hidden parts
  /// Continues across these joints, across junctions and shared nodes; null: it doesn't.
  const connections::JoinedSheets* across = nullptr;
};

/// Returns the region that contains the shells `start`. A region that begins in a fillet (mesh/select/fillets.h) is the fillet; creases of
/// varying angle count as a whole (mesh/select/crease_lines.h). The angle of a crease is measured between the directions of the two shells
/// away from their edge, so the orientation of normals makes no difference. A shell too thin to have a plane (width less than 1/200 of its
/// length) is crossed, and the shells beyond it are compared with those before it.
ShellSet region(const Model& model, const ShellSet& start, const RegionOptions& options);

/// Returns the shells at which a region begins: those at a node, or those closest to a point, which are all that come as close within a
/// thousandth of the closest one's longest edge. Empty if all parts there are hidden.
ShellSet shells_at(const Model& model, NodeIndex node, OutOfSight out_of_sight);
ShellSet shells_near(const Model& model, const Vec3& point, OutOfSight out_of_sight);

/// Returns the node nearest to a point; of equals the first.
NodeIndex nearest_node(const Model& model, const Vec3& point);

/// Adds a ring of neighbours / removes the rim, `rings` times. The rim of nodes: those with a neighbour that isn't selected; of shells:
/// those that touch one that isn't selected. A sheet's own boundary doesn't count as rim.
NodeSet grow(const Model& model, const NodeSet& nodes, int rings, OutOfSight out_of_sight = {});
NodeSet shrink(const Model& model, const NodeSet& nodes, int rings, OutOfSight out_of_sight = {});
ShellSet grow_shells(const Model& model, const ShellSet& shells, int rings, OutOfSight out_of_sight = {});
ShellSet shrink_shells(const Model& model, const ShellSet& shells, int rings, OutOfSight out_of_sight = {});

NodeSet invert(const Model& model, const NodeSet& nodes);

}  // namespace prismesh::mesh::select
