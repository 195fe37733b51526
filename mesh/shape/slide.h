// Moving nodes along the surface: each walks over the faces as they were, straight on, round creases too.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::shape {

/// The surface under nodes that are about to slide. A quad counts as the two triangles at its diagonal from the first corner to the
/// third. A node sets out in the direction in which its displacement points along the surface, and goes as far as the displacement is long
/// there. On each face it goes straight; at an edge it goes on as if the two faces lay in one plane, however sharp the crease: only faces
/// that hang together with its own are ever reached, never a sheet close by. Where three or more shells meet in an edge it goes on over the
/// one that leads straightest on. A node on a free edge stays on the line of free edges and stops at its corners (as FreeEdges has them);
/// a way that meets a free edge from within ends there. A node without a shell stays.
class Slideway {
 public:
  /// `nodes` with their `normals` (of unit length; zero without a shell). Copies no mesh: it shares the model's chunks.
  Slideway(const Model& surface, const NodeSet& nodes, std::vector<Vec3> normals);

  /// Where the nodes come to for a displacement of each. With `max_move` a way ends where it is that far from its start, as the crow
  /// flies. Returns how many ended so.
  std::size_t positions(std::span<const Vec3> by, std::optional<double> max_move, std::span<Vec3> out) const;

 private:
  Model surface_;
  NodeSet nodes_;
  std::vector<Vec3> normals_;
  std::vector<std::uint8_t> on_free_edge_;  ///< of each
};

}  // namespace prismesh::mesh::shape
