// Symmetric editing: finds pairs of nodes that are images in a plane, and combines moves with their mirror images.
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

  double height(const Vec3& position) const { return (position - point).dot(normal); }
  Vec3 mirrored_position(const Vec3& position) const { return position - 2 * height(position) * normal; }
  Vec3 mirrored(const Vec3& direction) const { return direction - 2 * direction.dot(normal) * normal; }
};

/// Returns the image of each node: the node nearest to its mirrored position, at most a quarter of the shortest shell side at the node away
/// (for nodes without a shell: of the median of the others). Each node belongs to one pair at most. The closest pairs are taken first; of
/// equally close pairs those within one part, then the first in the model. A node on the plane is its own image. Invalid: no image.
std::vector<NodeIndex> find_images(const Model& model, const NodeSet& nodes, const Plane& plane);

/// What `mirror_moves` needs of each node.
struct Mirrored {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t image = kNone;  ///< position of the node's image
  double own = 1;               ///< the share of the node's own move; the rest is the mirrored move of its image
};

/// Fills the shares `own` for nodes with these weights (0: not acted on). A node whose image isn't acted on moves by its own move alone,
/// and its image by the mirrored one. Where both are acted on, a move counts by its node's weight times 1 + s, where s goes from 0 in the
/// plane to 1 at the grab's distance from the plane on the grab's side, and to -1 on the other. So both halves meet in the plane without a
/// step, and a node on the plane stays on it.
void find_shares(const Plane& plane, std::span<const Vec3> start, std::span<const double> weight, const Vec3& grab,
                 std::span<Mirrored> nodes);

/// Returns the moves of all nodes, combined with the mirrored moves of their images. Two nodes of a pair get mirrored moves: to the bit for
/// a plane at right angles to a coordinate axis.
std::vector<Vec3> mirror_moves(const Plane& plane, std::span<const Mirrored> nodes, std::span<const Vec3> moves);

}  // namespace prismesh::mesh::shape
