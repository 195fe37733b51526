// Divides edges by new nodes, and the shells at them. Private to mesh/repair.
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

/// The new nodes on divided edges: pieces - 1 on each, made once.
class EdgeCuts {
 public:
  explicit EdgeCuts(const RepairContext& context, int pieces = 2) : context_(context), pieces_(pieces) {}

  /// The nodes on an edge in the order from `a` to `b`. Where the edge can't be divided, refusal() says why.
  std::vector<LocalNode> cut(LocalNode a, LocalNode b);
  /// The first of them.
  LocalNode middle(LocalNode a, LocalNode b) { return cut(a, b).front(); }
  const Refusal& refusal() const { return refusal_; }
  int pieces() const { return pieces_; }

 private:
  /// Makes them in the order from the lower to the higher node.
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

/// Divides a quad into pieces side by side, across the edge and the opposite one.
Refusal divide_quad(const RepairContext& context, const EdgeAt& at, EdgeCuts& cuts);
/// Divides or reshapes a shell of which only one edge is divided, at `middle`.
Refusal end_row(const RepairContext& context, const EdgeAt& at, LocalNode middle, RowEnd end);

}  // namespace prismesh::mesh::repair
