#include "mesh/relax/feature_lines.h"

#include <algorithm>
#include <cmath>

#include "mesh/model/features.h"

namespace prismesh::mesh::relax {

namespace {

/// The shells at an edge besides `shell`: how many, and one of them.
struct Others {
  int count = 0;
  ShellIndex shell;
};
Others others_at(const Model& model, ShellIndex shell, NodeIndex a, NodeIndex b) {
  Others others;
  for (const ShellIndex candidate : model.adjacency->shells_of(a)) {
    if (candidate == shell) continue;
    const ShellNodes& nodes = model.shell(candidate);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const NodeIndex from = nodes.node[i], to = nodes.node[(i + 1) % corners];
      if ((from == a && to == b) || (from == b && to == a)) {
        ++others.count;
        others.shell = candidate;
        break;
      }
    }
  }
  return others;
}

Edge edge_of(NodeIndex a, NodeIndex b) { return a < b ? Edge{a, b} : Edge{b, a}; }

}  // namespace

ShellIndex across(const Model& model, ShellIndex shell, NodeIndex a, NodeIndex b, double cos_limit) {
  const Others others = others_at(model, shell, a, b);
  if (others.count != 1) return {};
  // the lower shell first: the same rounding from either side
  const ShellIndex low = std::min(shell, others.shell), high = std::max(shell, others.shell);
  return is_crease(model, low, high, edge_of(a, b), cos_limit) ? ShellIndex() : others.shell;
}

LineEnds line_ends(const Model& model, NodeIndex node, double cos_limit, bool part_borders) {
  LineEnds ends;
  const auto add = [&](NodeIndex other) {
    const auto last = ends.other.begin() + static_cast<std::ptrdiff_t>(ends.count);
    const auto at = std::lower_bound(ends.other.begin(), last, other);
    if ((at != last && *at == other) || ends.count == LineEnds::kMost) return;
    std::copy_backward(at, last, last + 1);
    *at = other;
    ++ends.count;
  };
  for (const ShellIndex shell : model.adjacency->shells_of(node)) {
    const ShellNodes& nodes = model.shell(shell);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const NodeIndex a = nodes.node[i], b = nodes.node[(i + 1) % corners];
      if ((a != node && b != node) || a == b) continue;
      const ShellIndex beyond = across(model, shell, a, b, cos_limit);
      if (!beyond.valid() || (part_borders && model.shell_parts[beyond.value] != model.shell_parts[shell.value])) add(a == node ? b : a);
    }
  }
  return ends;
}

bool passes_through(const Model& model, NodeIndex node, const LineEnds& ends, double cos_limit) {
  if (ends.count != 2) return false;
  const Vec3 in = model.position(node) - model.position(ends.other[0]);
  const Vec3 out = model.position(ends.other[1]) - model.position(node);
  return in.dot(out) >= cos_limit * std::sqrt(in.squaredNorm() * out.squaredNorm()) && in.squaredNorm() > 0 && out.squaredNorm() > 0;
}

}  // namespace prismesh::mesh::relax
