// Which shells come to touch others while they are moved: for each step of a drag.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "mesh/contact/contact_thickness.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// A moved shell and one that isn't moved.
struct Touch {
  ShellIndex moved, other;
  bool cross = false;  ///< else they are too close
  double depth = 0;    ///< of two that are too close: mean thickness less distance; 0 of two that cross
};

class MovedShells {
 public:
  /// `nodes` move, `shells` are those at them, both ascending. Finds what touches before, at the cost of a step. The tree, a copy of which
  /// is kept, and the thickness are those of the model. Preconditions: the model has its adjacency; the thickness isn't null.
  MovedShells(const Model& model, const spatial::BoxTree& tree, std::shared_ptr<const ContactThickness> thickness, const NodeSet& nodes,
              const ShellSet& shells);

  /// Pairs of a moved and another shell that cross or are too close at these positions of the nodes, and weren't before; ascending, on all
  /// cores, the same whatever their number. Each moved shell that touches has at least one: all that it crosses; else the pair with the
  /// nearest centre, if that is too close, so that a step needn't measure all; else all. What counts is as in find_shell_crossings and
  /// find_close_shells, for each pair alone: T-junctions and seams that come about count. Costs the moved shells and what is near them,
  /// not the model. Positions that aren't finite touch nothing. Precondition: one position a node.
  std::vector<Touch> at(std::span<const Vec3> positions);

 private:
  /// That weren't before. `all`: every pair.
  std::vector<Touch> touches(bool all) const;
  void add_touches(ShellIndex shell, bool all, std::vector<Touch>& found) const;
  bool was_before(ShellIndex moved, ShellIndex other) const;

  Model model_;  ///< with the positions of the last step
  spatial::BoxTree tree_;
  std::shared_ptr<const ContactThickness> thickness_;
  NodeSet nodes_;
  ShellSet shells_;
  std::vector<std::uint8_t> is_moved_;  ///< one a shell of the model
  double max_thickness_ = 0;
  std::vector<std::pair<ShellIndex, ShellIndex>> before_;  ///< ascending
};

/// The parts that touch, in short.
struct TouchSummary {
  std::size_t parts = 0;     ///< that take part, each counted once; shells without a part are one
  PartIndex part_a, part_b;  ///< of the worst pair: one that crosses, else the deepest; the moved one first
  bool cross = false;        ///< that pair crosses
  double depth = 0;          ///< of that pair
};
/// Precondition: there is a touch.
TouchSummary summary_of(const Model& model, std::span<const Touch> touches);

}  // namespace prismesh::mesh::contact
