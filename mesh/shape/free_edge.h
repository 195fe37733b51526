// Finds the free edges of a part within a selection, and the line of them that runs through a node.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::shape {

/// Counts the free edges at a node; `ends` gets the other ends of the first two.
int free_edges_at(const Model& model, NodeIndex node, std::array<NodeIndex, 2>& ends);
/// Whether the angle of the surface around a boundary node is less than 135 or more than 250 degrees.
bool is_boundary_corner(const Model& model, NodeIndex node);

/// The free edges (edges of exactly one shell) with both ends in a selection. Nodes are positions in the selection.
class FreeEdges {
 public:
  FreeEdges(const Model& model, const NodeSet& selection);

  bool any() const { return !neighbours_.empty(); }
  bool touches(std::uint32_t node) const { return first_[node] != first_[node + 1]; }
  /// The other ends of the node's free edges, ascending.
  std::span<const std::uint32_t> neighbours(std::uint32_t node) const {
    return std::span(neighbours_).subspan(first_[node], first_[node + 1] - first_[node]);
  }

  /// Returns the nodes of the line of free edges through `node`, ascending: along the boundary in both directions up to and including its
  /// corners (is_boundary_corner), its forks and the nodes marked in `border`. A node that is a corner itself has several such lines; those
  /// that reach the border are left out if another doesn't.
  std::vector<std::uint32_t> through(std::uint32_t node, std::span<const std::uint8_t> border) const;

  /// How many lines through the node end on the border: of those that `through` returns.
  std::size_t count_held_lines(std::uint32_t node, std::span<const std::uint8_t> border) const;

  /// Marks the nodes of holes: of closed lines without a node on the border that the surface surrounds, so that it turns by more than half
  /// a turn against them. The end of a tube doesn't turn, the outer edge of a sheet turns the other way.
  std::vector<std::uint8_t> on_holes(std::span<const std::uint8_t> border) const;

 private:
  using Line = std::vector<std::uint32_t>;
  std::vector<Line> lines_through(std::uint32_t node, std::span<const std::uint8_t> border) const;
  bool is_corner(std::uint32_t node) const;
  Line walk(std::uint32_t from, std::uint32_t to, std::span<const std::uint8_t> border) const;

  const Model& model_;
  const NodeSet& selection_;
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace prismesh::mesh::shape
