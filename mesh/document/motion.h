// The nodes that a shaping edit moves, and their positions at a displacement. Applying an edit and dragging share it, so that a drag shows
// bit for bit what its edit will do. Private to mesh/document.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesh/document/edit.h"
#include "mesh/model/node_set.h"
#include "mesh/shape/axis.h"
#include "mesh/shape/mirror.h"
#include "mesh/shape/surface_tracer.h"

namespace prismesh::mesh::document {

enum class ShapingKind : std::uint8_t { translate, lift, slide, rotate, move };

/// Everything about a motion that doesn't depend on the displacement.
struct Motion {
  /// A node for which no weight is known: a mid-side node follows the ends of its edge, half each; the node of a weld that lies on a
  /// shell follows its corners. Positions in `nodes`; followers never follow followers.
  struct Follower {
    static constexpr std::uint32_t kStays = 0xffffffffu;
    std::uint32_t node = 0;
    std::array<std::uint32_t, 4> of{kStays, kStays, kStays, kStays};
    std::array<double, 4> share{};
  };

  ShapingKind kind = ShapingKind::translate;
  NodeSet nodes;                                       ///< those with weight > 0, their images and followers
  std::vector<double> weight;                          ///< of each
  std::vector<Vec3> start;                             ///< of each
  std::vector<Vec3> normals;                           ///< lift: of each, or one for all
  shape::Axis axis;                                    ///< rotate, move
  std::shared_ptr<const shape::SurfaceTracer> tracer;  ///< slide
  std::vector<Eigen::Quaterniond> turns;               ///< slide: how `by` turns on its way to each node
  std::optional<shape::Plane> plane;                   ///< of symmetry
  std::vector<shape::Mirrored> mirrored;               ///< with a plane: of each
  std::size_t without_image = 0;                       ///< nodes acted on that have no image in the plane
  NodeIndex grab;
  Vec3 normal = Vec3::Zero();  ///< unit normal at the grab; zero where no shell is
  std::vector<Follower> followers;
  std::size_t unreached = 0;    ///< nodes acted on with no way from the grab
  std::size_t free_ending = 0;  ///< nodes of free endings (shape::Weights)
  NodeIndex edge;               ///< on the free edge that is the origin; invalid: none
  NodeIndex other_edge;         ///< on the one that it would be with weighted free ends, if that differs
  std::optional<double> max_move;

  /// Position of a node in `nodes`, or Follower::kStays. Costs a binary search.
  std::uint32_t place_of(NodeIndex node) const;
};

/// Positions of motion.nodes at a displacement. `out` has one entry each. Returns how many nodes max_move held back.
std::size_t positions_at(const Motion& motion, const Displacement& displacement, std::span<Vec3> out);

}  // namespace prismesh::mesh::document
