#include "mesh/select/region.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"

namespace prismesh::mesh::select {

namespace {

ShellSet without(const ShellSet& all, const ShellSet& some) {
  ShellSet rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

}  // namespace

ShellSet region(const Model& model, NodeIndex start, double angle_degrees) {
  ShellSet found;
  if (start.value >= model.node_count()) return found;
  const Adjacency& adjacency = *model.adjacency;
  std::vector<std::uint8_t> seen(model.shell_count(), 0);
  const auto reach = [&](ShellIndex shell) {
    if (seen[shell.value] != 0) return;
    seen[shell.value] = 1;
    found.push_back(shell);
  };
  for (const ShellIndex shell : adjacency.shells_of(start)) reach(shell);
  for (std::size_t at = 0; at < found.size(); ++at) {
    const ShellNodes& nodes = model.shell(found[at]);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const auto [low, high] = std::minmax(nodes.node[i], nodes.node[(i + 1) % corners]);
      if (low == high) continue;
      const EdgeIndex edge = adjacency.find_edge(low, high);
      if (!edge.valid()) continue;
      // most edges lead back to where the search came from: only those that lead on are worth classifying
      const auto shells = adjacency.shells_of(edge);
      if (shells.size() != 2 || (seen[shells[0].value] != 0 && seen[shells[1].value] != 0)) continue;
      if (classify_edge(model, edge, {low, high}, angle_degrees) != EdgeKind::smooth) continue;
      for (const ShellIndex shell : shells) reach(shell);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

NodeIndex nearest_node(const Model& model, const Vec3& point) {
  struct Nearest {
    double distance2 = std::numeric_limits<double>::infinity();
    NodeIndex node;
  };
  const auto closer = [](const Nearest& a, const Nearest& b) {
    return a.distance2 < b.distance2 || (a.distance2 == b.distance2 && a.node < b.node);
  };
  std::vector<Nearest> of_range(model.positions.chunk_count());
  parallel_for(model.positions.chunk_count(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const auto positions = model.positions.chunk(c);
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const std::size_t node = c * kChunkSize + i;
        const Nearest candidate{(positions[i] - point).squaredNorm(), NodeIndex(node)};
        if (closer(candidate, of_range[c])) of_range[c] = candidate;
      }
    }
  });
  Nearest best;
  for (const Nearest& candidate : of_range)
    if (closer(candidate, best)) best = candidate;
  return best.node;
}

NodeSet grow(const Model& model, const NodeSet& nodes, int rings) {
  NodeSet grown = nodes;
  for (int ring = 0; ring < rings; ++ring) {
    const NodeSet reached = nodes_of(model, shells_touching(model, grown));
    NodeSet both;
    both.reserve(reached.size());
    std::set_union(grown.begin(), grown.end(), reached.begin(), reached.end(), std::back_inserter(both));
    if (both.size() == grown.size()) break;
    grown = std::move(both);
  }
  return grown;
}

NodeSet shrink(const Model& model, const NodeSet& nodes, int rings) {
  NodeSet left = nodes;
  for (int ring = 0; ring < rings && !left.empty(); ++ring) {
    const NodeSet rim = nodes_of(model, without(shells_touching(model, left), shells_inside(model, left)));
    NodeSet inner;
    std::set_difference(left.begin(), left.end(), rim.begin(), rim.end(), std::back_inserter(inner));
    if (inner.size() == left.size()) break;
    left = std::move(inner);
  }
  return left;
}

NodeSet invert(const Model& model, const NodeSet& nodes) {
  NodeSet rest;
  rest.reserve(model.node_count() - std::min(nodes.size(), model.node_count()));
  std::size_t next = 0;
  for (std::size_t i = 0; i < model.node_count(); ++i) {
    if (next < nodes.size() && nodes[next].value == i)
      ++next;
    else
      rest.push_back(NodeIndex(i));
  }
  return rest;
}

}  // namespace prismesh::mesh::select
