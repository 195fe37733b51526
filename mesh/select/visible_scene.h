// A model projected into a view, with an exact test whether a shell hides a node. Private to mesh/select.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/large_memory.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/select/projection.h"

namespace prismesh::mesh::select {

/// A shell this close to a node lies on it and doesn't hide it; a share of the shell's longest edge.
inline constexpr double kLiesOnShell = 1e-3;

/// A point in the picture: normalised device coordinates, z is the depth.
using Seen = Vec3;

struct SeenNode {
  Seen at = Seen::Zero();
  NodeIndex node;
};

/// The visible part of a shell behind the near plane, as triangles: none if the near plane clips the whole shell, two for a quad, more
/// where the near plane cuts it.
struct SeenShell {
  ShellIndex shell;
  std::array<NodeIndex, 4> corner;                      ///< of the shell
  std::array<Seen, 10> point;                           ///< its corners, or those of the two polygons left after clipping
  std::array<std::array<std::uint8_t, 3>, 6> triangle;  ///< into `point`
  std::size_t triangles = 0;
  bool is_cut = false;  ///< by the near plane; else `point` are its corners
  Seen low, high;       ///< the box around them

  bool is_own(NodeIndex node) const { return node == corner[0] || node == corner[1] || node == corner[2] || node == corner[3]; }
};

class Scene {
 public:
  /// `nodes` are the candidates that lie in the picture. Cost: a pass over the model's nodes.
  Scene(const Model& model, const ViewMatrix& view, const NodeSet& candidates, std::span<const std::uint8_t> out_of_sight);

  const std::vector<SeenNode>& nodes() const { return nodes_; }
  const Seen& low() const { return low_; }  ///< the box around `nodes`
  const Seen& high() const { return high_; }
  const Model& model() const { return model_; }

  /// Whether the shell may hide any of the nodes. Cheap and conservative: true where it isn't sure.
  bool may_hide(std::size_t shell) const {
    const ShellNodes& corners = model_.shell_nodes[shell];
    if (!corners.node[0].valid()) return false;
    std::uint8_t beyond = 0xff;
    for (const NodeIndex node : corners.node) beyond &= beyond_[node.value];
    return beyond == 0 && in_sight(shell);
  }
  SeenShell seen(ShellIndex shell) const;

  /// Whether the shell hides the node: compares depths at the node's place in the projected triangles, in double precision. The two
  /// triangles at a side give the same bits there, so no ray passes between them.
  bool hides(const SeenShell& shell, const SeenNode& node) const;

 private:
  std::size_t cut_at_near_plane(SeenShell& shell) const;  ///< returns how many points are left
  bool in_sight(std::size_t shell) const {
    const PartIndex part = model_.shell_parts[shell];
    return out_of_sight_.empty() || !part.valid() || out_of_sight_[part.value] == 0;
  }
  void find_nodes(const NodeSet& candidates);
  void project();
  void find_midside_owners();
  bool is_midside_of(NodeIndex node, ShellIndex shell) const;
  bool lies_on(NodeIndex node, const SeenShell& shell) const;

  const Model& model_;
  const ViewMatrix& view_;
  std::span<const std::uint8_t> out_of_sight_;
  std::vector<SeenNode> nodes_;
  Seen low_, high_;
  LargeBlock seen_bytes_;
  std::span<Seen> seen_;              ///< of each node of the model; undefined before the near plane
  std::vector<std::uint8_t> beyond_;  ///< of each node of the model: the planes around `nodes_` that it is beyond
  std::vector<std::pair<NodeIndex, ShellIndex>> midside_owners_;  ///< ascending; of nodes in nodes_
};

}  // namespace prismesh::mesh::select
