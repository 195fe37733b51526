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
  for (const ShellIndex candidate : model.adjacency->shells_of(a))
    if (candidate != shell && has_edge(model.shell(candidate), a, b)) {
      ++others.count;
      others.shell = candidate;
    }
  return others;
}

Edge edge_between(NodeIndex a, NodeIndex b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// Whether the edge between two shells is a crease. Takes the lower shell first, so that rounding is the same from either side.
bool make_crease(const Model& model, ShellIndex one, ShellIndex other, const Edge& edge, double cos_limit) {
  return is_crease(model, std::min(one, other), std::max(one, other), edge, cos_limit);
}

}  // namespace

bool has_edge(const ShellNodes& shell, NodeIndex a, NodeIndex b) {
  const int corners = shell.corners();
  for (int i = 0; i < corners; ++i) {
    const NodeIndex from = shell.node[i], to = shell.node[next_corner(i, corners)];
    if ((from == a && to == b) || (from == b && to == a)) return true;
  }
  return false;
}

ShellIndex smooth_neighbour(const Model& model, ShellIndex shell, NodeIndex a, NodeIndex b, double cos_limit) {
  const Others others = others_at(model, shell, a, b);
  return others.count == 1 && !make_crease(model, shell, others.shell, edge_between(a, b), cos_limit) ? others.shell : ShellIndex();
}

LineEnds line_ends(const Model& model, NodeIndex node, double cos_limit, bool part_borders) {
  LineEnds ends;
  const auto add = [&](NodeIndex other) {
    const auto last = ends.other.begin() + static_cast<std::ptrdiff_t>(ends.count);
    const auto at = std::lower_bound(ends.other.begin(), last, other);
    if ((at != last && *at == other) || ends.count == LineEnds::kMax) return;
    std::copy_backward(at, last, last + 1);
    *at = other;
    ++ends.count;
  };
  for (const ShellIndex shell : model.adjacency->shells_of(node)) {
    const ShellNodes& nodes = model.shell(shell);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const NodeIndex a = nodes.node[i], b = nodes.node[next_corner(i, corners)];
      if ((a != node && b != node) || a == b) continue;
      const Others others = others_at(model, shell, node, a == node ? b : a);
      if (others.count == 1 && others.shell < shell) continue;  // the other shell has answered already
      if (others.count != 1 || (part_borders && model.shell_parts[others.shell.value] != model.shell_parts[shell.value]) ||
          make_crease(model, shell, others.shell, edge_between(a, b), cos_limit))
        add(a == node ? b : a);
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
