// Finds feature edges: creases, free edges and junctions of three or more shells.
#pragma once

#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"

namespace prismesh::mesh {

enum class EdgeKind : std::uint8_t { smooth, crease, free, junction };  ///< junction: three or more shells

/// Classifies one edge. With two shells it is a crease if their planes differ by more than `angle_degrees`. The angle is measured between
/// the shells' directions away from the edge, so the orientation of their normals doesn't matter.
EdgeKind classify_edge(const Model& model, EdgeIndex edge, Edge ends, double angle_degrees);

/// The same for two shells at one edge; `cos_limit` is the cosine of the angle.
bool is_crease(const Model& model, ShellIndex first, ShellIndex second, Edge ends, double cos_limit);

/// How two shells at one edge bend.
struct Bend {
  double degrees = 0;  ///< 0 in a plane sheet, 180 folded back; 0 where a shell has no width
  double width = 0;    ///< of the narrower shell: twice its centre's distance from the edge's line
  Vec3 beyond;         ///< from the edge's middle into the second shell, at right angles to the edge
};
Bend bend_between(const Model& model, ShellIndex first, ShellIndex second, Edge ends);

/// Classifies every edge.
std::vector<EdgeKind> classify_edges(const Model& model, double angle_degrees);

}  // namespace prismesh::mesh
