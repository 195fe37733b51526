// Symmetric editing within a motion: the images join what moves. Private to mesh/document.
#pragma once

#include <utility>
#include <vector>

#include "mesh/document/motion.h"

namespace prismesh::mesh::document {

/// The plane of a symmetry. Errors: no direction, numbers that aren't finite.
Result<shape::Plane> plane_of(const Symmetry& symmetry);

/// Nodes acted on (weight > 0) and their images, each with the other one; ascending.
struct Images {
  std::vector<std::pair<NodeIndex, NodeIndex>> of;
  std::size_t missing = 0;  ///< nodes acted on without one

  NodeIndex find(NodeIndex node) const;  ///< invalid without one
};
Images find_images(const Model& model, const shape::Weights& weights, const shape::Plane& plane);

/// The weights with the images among the nodes: an image that isn't acted on itself gets the weight of what it mirrors, so that it counts
/// as moving.
shape::Weights with_images(const shape::Weights& weights, const Images& images);

/// Once motion.nodes stand: the own weights again, and how each node's move and its image's become one.
void link_images(const shape::Weights& weights, const Images& images, const shape::Plane& plane, Motion& motion);

}  // namespace prismesh::mesh::document
