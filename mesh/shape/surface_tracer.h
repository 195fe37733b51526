// Moving nodes along the surface: each walks over the faces as they were, straight on, round creases too.
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

/// The surface under nodes that are about to slide. A quad counts as the two triangles at its diagonal from the first corner to the
/// third. A node sets out in the direction in which its displacement points along the surface, and goes as far as the displacement is long
/// there, over 10,000 faces at most. On each face it goes straight; at an edge it goes on as if the two faces lay in one plane, however
/// sharp the crease: only faces that hang together with its own are ever reached, never a sheet close by. Where three or more shells meet
/// in an edge it goes on over the one that leads straightest on. A node on a free edge stays on the line of free edges and stops at its
/// corners (as FreeEdges has them); a way that meets a free edge from within ends there. A node without a shell stays.
class SurfaceTracer {
 public:
  /// `nodes` with their `normals` (of unit length; zero without a shell). Copies no mesh: it shares the model's chunks.
  SurfaceTracer(const Model& surface, const NodeSet& nodes, std::vector<Vec3> normals);

  /// These nodes keep to the plane at right angles to `normal` that they lie in: they walk where it cuts the surface. `nodes` has one
  /// entry for each, other than 0 for those.
  void keep_in_plane(const Vec3& normal, std::vector<std::uint8_t> nodes);

  /// Where the nodes come to for a displacement of each. With `max_move` a way ends where it is that far from its start, as the crow
  /// flies. Returns how many ended so.
  std::size_t positions(std::span<const Vec3> by, std::optional<double> max_move, std::span<Vec3> out) const;

 private:
  Model surface_;
  NodeSet nodes_;
  std::vector<Vec3> normals_;
  std::vector<std::uint8_t> on_free_edge_;  ///< of each
  Vec3 plane_ = Vec3::Zero();               ///< normal
  std::vector<std::uint8_t> in_plane_;      ///< of each; empty: none
};

/// How a direction at `from` turns on its way over the surface to each of `nodes`: from node to node by the smallest turn that takes one's
/// normal to the other's. So what leads along a sheet at one place leads along it everywhere, round a bend or a crease too. As it is
/// where no way within the nodes leads.
std::vector<Eigen::Quaterniond> turns_along(const Model& model, const NodeSet& nodes, std::span<const Vec3> normals, NodeIndex from);

}  // namespace prismesh::mesh::shape
