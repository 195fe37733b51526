// The springs of the nodes to be relaxed, and where these are: edges of shells and diagonals of quads. Private to mesh/relax.
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
  float weight = 0;  ///< how many shells it is in
  float rest = 0;    ///< length at rest; deck's unit
};

/// Local numbers: movable nodes first, then those around them that stay.
struct Net {
  std::size_t movable = 0;
  std::vector<NodeIndex> nodes;
  std::vector<Vec3> start;
  std::vector<double> size;                 ///< of the elements about each node: how long its edges should be
  std::vector<SurfaceAnchor> anchor;        ///< of the movable ones
  std::vector<std::uint32_t> first_spring;  ///< of the movable ones, and one more
  std::vector<Spring> springs;
  std::vector<std::vector<std::uint32_t>> colours;   ///< movable nodes, no two of a colour in one shell
  ShellSet shells;                                   ///< with a movable node
  std::vector<std::array<std::int32_t, 4>> corners;  ///< of each, local numbers; a triangle repeats its third

  std::span<const Spring> springs_of(std::size_t node) const {
    return std::span(springs).subspan(first_spring[node], first_spring[node + 1] - first_spring[node]);
  }
};

/// Nodes of `movable` that are corners, not finite, in no shell or not near the surface stay. Errors: cancelled.
Result<Net> make_net(const Model& model, const ReferenceSurface& surface, const NodeSet& movable, double feature_angle,
                     const Progress& progress);

}  // namespace prismesh::mesh::relax
