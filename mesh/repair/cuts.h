// Cuts through edges, and what they make of the shells there. Inner to repair.
#pragma once

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/reshaping.h"
#include "mesh/repair/row.h"

namespace prismesh::mesh::repair {

using EdgeKey = std::pair<LocalNode, LocalNode>;  ///< the lower one first
inline EdgeKey edge_key(LocalNode a, LocalNode b) { return {std::min(a, b), std::max(a, b)}; }

/// New nodes on edges, each made once, so many to an edge that it has `pieces`.
class EdgeCuts {
 public:
  explicit EdgeCuts(const RepairContext& context, int pieces = 2) : context_(context), pieces_(pieces) {}

  /// The nodes on an edge on the way from `a` to `b`; a refusal is remembered.
  std::vector<LocalNode> cut(LocalNode a, LocalNode b);
  /// The first of them.
  LocalNode middle(LocalNode a, LocalNode b) { return cut(a, b).front(); }
  const Refusal& refusal() const { return refusal_; }
  int pieces() const { return pieces_; }

 private:
  /// All of them from the lower to the higher node.
  std::vector<LocalNode> make(LocalNode a, LocalNode b);

  const RepairContext& context_;
  int pieces_;
  std::map<EdgeKey, std::vector<LocalNode>> cuts_;
  Refusal refusal_;
};

struct EdgeAt {
  LocalShell shell;
  std::size_t edge = 0;  ///< from corner `edge` to the next
};

/// A quad into pieces side by side, across the edge and the one opposite.
Refusal divide_quad(const RepairContext& context, const EdgeAt& at, EdgeCuts& cuts);
/// A shell of which only one edge is cut, at `middle`.
Refusal end_row(const RepairContext& context, const EdgeAt& at, LocalNode middle, RowEnd end);

}  // namespace prismesh::mesh::repair
