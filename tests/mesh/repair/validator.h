// Looks at a repaired model by other means than repairing does: maps over edges and nodes, built from scratch.
#pragma once

#include <string>

#include "mesh/model/model.h"

namespace prismesh::mesh::repair {

/// What repairing mustn't change, or may by a little only.
struct Shape {
  long euler = 0;              ///< nodes in use - edges + shells
  std::size_t free_loops = 0;  ///< connected pieces of the free edges
  std::size_t pieces = 0;      ///< connected pieces of the shells, over edges
  double free_length = 0;
  double junction_length = 0;  ///< edges of three and more shells
  double border_length = 0;    ///< edges between parts
  double crease_length = 0;    ///< edges sharper than 60 degrees
  double area = 0;
  std::size_t most_shells_an_edge = 0;
};
Shape shape_of(const Model& model);

/// What is wrong with a model, in words; empty: nothing. Repeated nodes, shells twice, nodes without shells, edges with shells turned
/// against each other (in a model made so that they agree).
std::string what_is_wrong(const Model& model);

/// Pairs of triangles with an edge in common, and triangles.
std::size_t triangle_pairs(const Model& model);
std::size_t triangles(const Model& model);

}  // namespace prismesh::mesh::repair
