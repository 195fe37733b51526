// Symmetric editing: which nodes are each other's images in a plane, and how a move and its mirror image become one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::shape {

struct Plane {
  Vec3 point = Vec3::Zero();   ///< any point on it
  Vec3 normal = Vec3::Zero();  ///< of length 1

  double height(const Vec3& place) const { return (place - point).dot(normal); }
  Vec3 mirrored_place(const Vec3& place) const { return place - 2 * height(place) * normal; }
  Vec3 mirrored(const Vec3& direction) const { return direction - 2 * direction.dot(normal) * normal; }
};

/// The image of each node: the node nearest to its mirrored place, not farther from it than a quarter of the shortest shell side at the
/// node (for nodes without a shell: of the middle one of the others). A node belongs to one pair at most, the closest pairs first; of pairs
/// equally close those of the same part, then the first in the model. A node on the plane is its own image. Invalid where there is none.
std::vector<NodeIndex> find_images(const Model& model, const NodeSet& nodes, const Plane& plane);

/// What `mirror_moves` needs to know of each node.
struct Mirrored {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t image = kNone;  ///< position of the node's image
  double own = 1;               ///< the share of the node's own move; the rest is the mirrored move of its image
};

/// The shares for nodes of these weights (0: not acted on). A node whose image isn't acted on moves by its own move alone, its image by
/// that one's mirrored. Where both are acted on, each counts by its weight and the more the farther it lies on the grab's side: from the
/// grab's distance off the plane on it alone, in the plane both alike. So the halves meet in the plane without a step, and a node on it
/// stays.
void find_shares(const Plane& plane, std::span<const Vec3> start, std::span<const double> weight, const Vec3& grab,
                 std::span<Mirrored> nodes);

/// The moves of all nodes, their images' mirrored ones included. Two nodes that are each other's images get mirror images, to the bit for a
/// plane at right angles to an axis of coordinates.
std::vector<Vec3> mirror_moves(const Plane& plane, std::span<const Mirrored> nodes, std::span<const Vec3> moves);

}  // namespace prismesh::mesh::shape
