// The spring net of the nodes to relax: springs along edges of shells and diagonals of quads. Private to mesh/relax.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/relax/surface_anchor.h"

namespace prismesh::mesh::relax {

struct Spring {
  std::uint32_t to = 0;
  float weight = 0;  ///< number of shells that it is in
  float rest = 0;    ///< rest length; deck's length unit
};

/// Nodes have local numbers: the movable ones first, then those about them, which stay.
struct SpringNet {
  std::size_t movable = 0;  ///< count of movable nodes
  std::vector<NodeIndex> nodes;
  std::vector<Vec3> start;                  ///< position of each node
  std::vector<double> size;                 ///< target edge length at each node
  std::vector<SurfaceAnchor> anchor;        ///< of the movable nodes
  std::vector<std::uint32_t> first_spring;  ///< of each movable node in `springs`, and the end
  std::vector<Spring> springs;
  std::vector<std::vector<std::uint32_t>> colours;   ///< graph colouring: movable nodes, no two of one colour in one shell
  ShellSet shells;                                   ///< those with a movable node
  std::vector<std::array<std::int32_t, 4>> corners;  ///< of each shell, local numbers; a triangle repeats its third

  std::span<const Spring> springs_of(std::size_t node) const {
    return std::span(springs).subspan(first_spring[node], first_spring[node + 1] - first_spring[node]);
  }
};

/// Makes the spring net of the `movable` nodes. Those that can't move are left out: corners of feature lines, nodes without shell, nodes
/// that aren't finite or not near the surface. `feature_angle` in degrees. Errors: cancelled.
Result<SpringNet> make_spring_net(const Model& model, const ReferenceSurface& surface, const NodeSet& movable, double feature_angle,
                                  const Progress& progress);

}  // namespace prismesh::mesh::relax
