// Symmetric editing: finds the images of the nodes acted on and adds them to a motion. Private to mesh/document.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "mesh/document/edit.h"
#include "mesh/document/motion.h"
#include "mesh/shape/mirror.h"
#include "mesh/shape/weights.h"

namespace prismesh::mesh::document {

/// The plane of a symmetry, and the images in it of the nodes acted on (weight > 0).
struct Mirroring {
  shape::Plane plane;
  std::vector<std::pair<NodeIndex, NodeIndex>> images;  ///< nodes acted on and their images, each with the other one; ascending
  std::size_t without_image = 0;                        ///< nodes acted on that have none

  NodeIndex image_of(NodeIndex node) const;  ///< invalid without one
};
/// Empty without a symmetry. Errors: no direction, numbers that aren't finite.
Result<std::optional<Mirroring>> find_mirroring(const Model& model, const shape::Weights& weights, const std::optional<Symmetry>& symmetry);

/// The weights of the nodes and their images. An image that isn't acted on itself gets the weight of the node it mirrors, so that it counts
/// as moving.
shape::Weights with_images(const shape::Weights& weights, const Mirroring& mirroring);

/// Enters the plane, and for each node its image and how the moves of both are added. Needs motion.nodes, weight, start and followers.
void link_images(const Mirroring& mirroring, Motion& motion);

}  // namespace prismesh::mesh::document
