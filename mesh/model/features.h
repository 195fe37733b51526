// Feature edges: where a sheet has a crease, an end, or meets another sheet.
#pragma once

#include <vector>

#include "mesh/model/adjacency.h"
#include "mesh/model/model.h"

namespace prismesh::mesh {

enum class EdgeKind : std::uint8_t { smooth, crease, free, junction };  ///< junction: three or more shells

/// The kind of one edge: with two shells it is a crease if their planes differ by more than `angle_degrees`, measured without
/// regard to the normals' signs (neighbours of one sheet often disagree), from how the shells lie about the edge.
EdgeKind classify_edge(const Model& model, EdgeIndex edge, Edge ends, double angle_degrees);

/// The same question of two shells at one edge; `cos_limit` is the angle's cosine.
bool is_crease(const Model& model, ShellIndex first, ShellIndex second, Edge ends, double cos_limit);

/// The kind of every edge.
std::vector<EdgeKind> classify_edges(const Model& model, double angle_degrees);

}  // namespace prismesh::mesh
