// Simplifies the triangles of one group of clusters. Private to mesh/lod.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mesh/lod/levels.h"

namespace prismesh::mesh::lod {

struct Simplified {
  std::vector<CoarseTriangle> triangles;
  double error = 0;  ///< how far a removed node or a removed piece of a border may be from what replaces it
};

/// Collapses edges, cheapest first, until at most `wanted` triangles are left or nothing more can be collapsed: a node goes to a neighbour.
/// Free edges, junctions and borders of parts collapse along themselves only; their ends and crossings stay, and so do locked nodes. Where
/// that leaves too much (small parts, many holes), nodes that share a cell of a grid are merged, whatever they belong to. Order of the
/// input decides between equals.
Simplified simplify(const Model& model, std::span<const CoarseTriangle> triangles, const std::function<bool(NodeIndex)>& is_locked,
                    std::size_t wanted);

}  // namespace prismesh::mesh::lod
