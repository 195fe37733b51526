// Which shells welds join: elements and constraints that reach from one sheet to another.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/references.h"
#include "mesh/select/in_sight.h"

namespace prismesh::mesh::select {

/// An end of a weld lies on a shell if it is this close; a share of the shell's longest edge.
inline constexpr double kWeldReach = 0.25;
/// What is longer than this many of the longest edge of the shells at its ends is no weld.
inline constexpr double kWeldLength = 2;

/// Pairs of shells, each in both orders, ascending.
class WeldedShells {
 public:
  WeldedShells() = default;
  explicit WeldedShells(std::vector<std::pair<ShellIndex, ShellIndex>> pairs);
  /// The shells on the other sides of the welds on this one.
  std::span<const std::pair<ShellIndex, ShellIndex>> of(ShellIndex shell) const;
  std::span<const std::pair<ShellIndex, ShellIndex>> all() const { return pairs_; }

 private:
  std::vector<std::pair<ShellIndex, ShellIndex>> pairs_;
};

/// What beams, solids, thick shells, springs and connectors join, and, where `references` isn't null, the deck's constrained spot welds and
/// rivets. An end is on the shells at its node; a node without shells in sight is on the shell closest to it within kWeldReach. Two ends
/// join their shells unless these touch each other (then the element stiffens a sheet) or lie farther apart than kWeldLength.
WeldedShells find_welds(const Model& model, const References* references, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::select
