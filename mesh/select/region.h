// Selections that follow the surface: regions of shells, rings of neighbours. Shells out of sight count as not there.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/select/welds.h"

namespace prismesh::mesh::select {

/// Where a region ends: at creases sharper than the angle, free edges and junctions of three or more shells; with its part; or where
/// nothing is connected any more by shared edges.
enum class RegionBound : std::uint8_t { features, part, piece };

struct RegionOptions {
  RegionBound bound = RegionBound::features;
  double angle_degrees = 30;             ///< features
  OutOfSight out_of_sight;               ///< parts that count as not there
  const WeldedShells* across = nullptr;  ///< goes on over what these welds join, over junctions and over shared nodes; null: it doesn't
};

/// The region that begins with the shells `start`. A crease is judged from how two shells lie about their edge, so normals that disagree
/// make no difference; a shell too thin to have a plane (less than 1/200 as wide as long) is passed, and the shells beyond are judged
/// against those before it.
ShellSet region(const Model& model, const ShellSet& start, const RegionOptions& options);

/// Where a region begins: the shells in sight at a node, or those closest to a point: of them all that pass as close, within a thousandth
/// of their edge. None if none is in sight.
ShellSet shells_at(const Model& model, NodeIndex node, OutOfSight out_of_sight);
ShellSet shells_near(const Model& model, const Vec3& point, OutOfSight out_of_sight);

/// The node nearest to a point, of equals the first.
NodeIndex nearest_node(const Model& model, const Vec3& point);

/// One ring of neighbours more / the rim less, `rings` times. For nodes the rim is those with a neighbour that isn't selected, for shells
/// those that touch one that isn't. A sheet's own boundary is no rim.
NodeSet grow(const Model& model, const NodeSet& nodes, int rings, OutOfSight out_of_sight = {});
NodeSet shrink(const Model& model, const NodeSet& nodes, int rings, OutOfSight out_of_sight = {});
ShellSet grow_shells(const Model& model, const ShellSet& shells, int rings, OutOfSight out_of_sight = {});
ShellSet shrink_shells(const Model& model, const ShellSet& shells, int rings, OutOfSight out_of_sight = {});

NodeSet invert(const Model& model, const NodeSet& nodes);

}  // namespace prismesh::mesh::select
