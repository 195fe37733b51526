// Finds the shells that welds join: elements and constraints that connect one sheet with another.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/model/references.h"
#include "mesh/select/in_sight.h"

namespace prismesh::mesh::select {

/// A weld's end lies on a shell if it is this close; a share of the shell's longest edge.
inline constexpr double kWeldReach = 0.25;
/// The max length of a weld, in longest edges of the shells at its ends.
inline constexpr double kWeldLength = 2;

/// Pairs of shells, each in both orders, ascending.
class WeldedShells {
 public:
  WeldedShells() = default;
  explicit WeldedShells(std::vector<std::pair<ShellIndex, ShellIndex>> pairs);
  /// The pairs of this shell with those that welds join to it.
  std::span<const std::pair<ShellIndex, ShellIndex>> of(ShellIndex shell) const;
  std::span<const std::pair<ShellIndex, ShellIndex>> all() const { return pairs_; }

 private:
  std::vector<std::pair<ShellIndex, ShellIndex>> pairs_;
};

/// Finds the shells that beams, solids, thick shells, springs and connectors join and, if `references` isn't null, those that the deck's
/// constrained spot welds and rivets join. An end lies on the shells at its node; if the node has none (or only hidden ones), on the
/// closest shell within kWeldReach. Two ends join their shells unless these touch each other (then the element stiffens a sheet) or lie
/// farther apart than kWeldLength.
WeldedShells find_welds(const Model& model, const References* references, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::select
