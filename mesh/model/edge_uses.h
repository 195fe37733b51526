// Collects the edges and shells at one node for the edge table. Private to mesh/model.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <span>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::mesh {

/// The distinct corners of a shell; a degenerate shell has fewer than it names, a removed one has none.
struct Corners {
  std::array<NodeIndex, 4> node;
  int count = 0;
};

inline Corners distinct_corners(const ShellNodes& shell) {
  Corners corners;
  if (!shell.node[0].valid()) return corners;
  for (const NodeIndex node : shell.node) {
    bool seen = false;
    for (int i = 0; i < corners.count; ++i) seen = seen || corners.node[i] == node;
    if (!seen) corners.node[corners.count++] = node;
  }
  return corners;
}

/// A shell at an edge whose low end is the current node.
struct EdgeUse {
  NodeIndex high;
  ShellIndex shell;
  auto operator<=>(const EdgeUse&) const = default;
};

/// Collects the uses of the node's edges whose low end it is, ascending, each once; `shells` are the node's.
inline void collect_uses(const Model& model, std::span<const ShellIndex> shells, NodeIndex low, std::vector<EdgeUse>& uses) {
  uses.clear();
  for (const ShellIndex shell : shells) {
    const ShellNodes& nodes = model.shell(shell);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      if (nodes.node[i] != low) continue;
      const NodeIndex next = nodes.node[i + 1 == corners ? 0 : i + 1];
      const NodeIndex previous = nodes.node[i == 0 ? corners - 1 : i - 1];
      if (next > low) uses.push_back({next, shell});
      if (previous > low) uses.push_back({previous, shell});
    }
  }
  // a handful of entries, half of them in place: insertion sort beats the general one
  for (std::size_t i = 1; i < uses.size(); ++i) {
    const EdgeUse use = uses[i];
    std::size_t place = i;
    for (; place > 0 && use < uses[place - 1]; --place) uses[place] = uses[place - 1];
    uses[place] = use;
  }
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
}

}  // namespace prismesh::mesh
