// Moves nodes along the surface: each follows a straight path over the faces as they were before the move, across creases too.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::shape {

/// Traces the paths of nodes that slide over a surface. A quad counts as the two triangles at its diagonal from the first corner to the
/// third.
/// - A path starts in the direction of the displacement's component along the surface and has the length of this component. It crosses at
///   most 10,000 faces.
/// - On a face the path is straight. At an edge it continues as if the two faces lay in one plane, however sharp the crease. So it reaches
///   only faces that are connected to its own by edges, never another sheet nearby.
/// - At an edge of three or more shells the path takes the shell with the smallest turn.
/// - A node on a free edge stays on the line of free edges and stops at its corners (see FreeEdges). A path that meets a free edge from
///   inside the sheet ends there. A node without a shell stays.
class SurfaceTracer {
 public:
  /// `normals`: one for each node, of unit length; zero without a shell. Copies no mesh: it shares the model's chunks.
  SurfaceTracer(const Model& surface, const NodeSet& nodes, std::vector<Vec3> normals);

  /// Keeps some nodes in the plane at right angles to `normal` that they lie in: their paths follow the line where this plane cuts the
  /// surface. `nodes` has one entry for each node, not 0 for those.
  void keep_in_plane(const Vec3& normal, std::vector<std::uint8_t> nodes);

  /// Computes the end of each node's path; `by` and `out` have one entry for each node. With `max_move` a path ends where its straight
  /// distance from its start reaches this value. Returns how many paths ended so.
  std::size_t positions(std::span<const Vec3> by, std::optional<double> max_move, std::span<Vec3> out) const;

 private:
  Model surface_;
  NodeSet nodes_;
  std::vector<Vec3> normals_;
  std::vector<std::uint8_t> on_free_edge_;  ///< of each
  Vec3 plane_ = Vec3::Zero();               ///< normal
  std::vector<std::uint8_t> in_plane_;      ///< of each; empty: none
};

/// Returns how a direction at `from` turns when it is transported over the surface to each of `nodes`: from node to node by the smallest
/// rotation that takes one normal to the other. So a direction along the sheet at one node is along the sheet at every node, also behind a
/// bend or a crease. The identity for nodes that no path within the set connects to `from`.
std::vector<Eigen::Quaterniond> turns_along(const Model& model, const NodeSet& nodes, std::span<const Vec3> normals, NodeIndex from);

}  // namespace prismesh::mesh::shape
