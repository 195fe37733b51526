#include "mesh/select/loops.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/deterministic_math.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::select {

namespace {

/// A free edge with its shell; the loop runs from `from` to `to`.
struct FreeEdge {
  EdgeIndex edge;
  ShellIndex shell;
  NodeIndex from;
  NodeIndex to;
};

class Sheet {
 public:
  Sheet(const Model& model, OutOfSight out_of_sight) : model_(model), adjacency_(*model.adjacency), out_of_sight_(out_of_sight) {}

  bool has(ShellIndex shell) const { return in_sight(model_, shell, out_of_sight_); }

  /// Free edges at a node whose shell isn't hidden.
  std::vector<FreeEdge> free_edges_at(NodeIndex node) const {
    std::vector<FreeEdge> edges;
    for (const ShellIndex shell : adjacency_.shells_of(node)) {
      if (!has(shell)) continue;
      for (const NodeIndex other : neighbours(shell, node)) {
        const EdgeIndex edge = adjacency_.find_edge(node, other);
        if (edge.valid() && adjacency_.shells_of(edge).size() == 1) edges.push_back({edge, shell, node, other});
      }
    }
    return edges;
  }

  /// Whether each edge at a node surely has two shells or more, seen from the shells alone: cheaper than asking for the edges.
  bool is_inner(NodeIndex node) const {
    constexpr std::size_t kMaxEdges = 16;
    std::array<NodeIndex, kMaxEdges> once;  // neighbours found in one shell so far
    std::array<NodeIndex, kMaxEdges> more;
    std::size_t once_count = 0, more_count = 0;
    for (const ShellIndex shell : adjacency_.shells_of(node)) {
      const std::array<NodeIndex, 2> both = neighbours(shell, node);
      if (both[0] == both[1]) return false;
      for (const NodeIndex other : both) {
        if (std::find(more.begin(), more.begin() + more_count, other) != more.begin() + more_count) continue;
        NodeIndex* const found = std::find(once.begin(), once.begin() + once_count, other);
        if (found == once.begin() + once_count) {
          if (once_count == kMaxEdges) return false;
          once[once_count++] = other;
        } else {
          if (more_count == kMaxEdges) return false;
          more[more_count++] = other;
          *found = once[--once_count];
        }
      }
    }
    return once_count == 0;
  }

  /// The next free edge of the loop at `to`, around the shells there.
  std::optional<FreeEdge> next(const FreeEdge& last) const {
    const NodeIndex at = last.to;
    NodeIndex came_over = last.from;
    ShellIndex shell = last.shell;
    for (std::size_t turn = 0; turn <= adjacency_.shells_of(at).size(); ++turn) {
      const auto [one, other] = neighbours(shell, at);
      const NodeIndex ahead = one == came_over ? other : one;
      const EdgeIndex edge = ahead.valid() && ahead != came_over ? adjacency_.find_edge(at, ahead) : EdgeIndex();
      if (!edge.valid()) return std::nullopt;
      if (adjacency_.shells_of(edge).size() == 1) return FreeEdge{edge, shell, at, ahead};
      shell = smallest_turn(shell, edge, at, ahead);
      if (!shell.valid()) return std::nullopt;
      came_over = ahead;
    }
    return std::nullopt;
  }

 private:
  /// The corners before and after `node` in the shell.
  std::array<NodeIndex, 2> neighbours(ShellIndex shell, NodeIndex node) const {
    const ShellNodes& nodes = model_.shell(shell);
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t i = 0; i < corners; ++i)
      if (nodes.node[i] == node) return {nodes.node[(i + corners - 1) % corners], nodes.node[(i + 1) % corners]};
    return {};
  }

  Vec3 away(ShellIndex shell, const Vec3& middle, const Vec3& along) const {
    const ShellNodes& nodes = model_.shell(shell);
    Vec3 out = -middle;
    for (const NodeIndex node : nodes.node) out += 0.25 * model_.position(node);
    return (out - along * (out.dot(along) / along.squaredNorm())).normalized();
  }

  /// The shell beyond the edge with the smallest turn, below 45 degrees.
  ShellIndex smallest_turn(ShellIndex shell, EdgeIndex edge, NodeIndex from, NodeIndex to) const {
    const auto shells = adjacency_.shells_of(edge);
    if (shells.size() == 2) {
      const ShellIndex other = shells[0] == shell ? shells[1] : shells[0];
      return has(other) ? other : ShellIndex();
    }
    const Vec3 along = model_.position(to) - model_.position(from);
    if (!(along.squaredNorm() > 0)) return {};
    const Vec3 middle = 0.5 * (model_.position(to) + model_.position(from));
    const Vec3 here = away(shell, middle, along);
    ShellIndex best;
    double max_cosine = deterministic_cos_degrees(45);
    for (const ShellIndex other : shells) {
      if (other == shell || !has(other)) continue;
      const double cosine = -here.dot(away(other, middle, along));
      if (cosine > max_cosine) max_cosine = cosine, best = other;
    }
    return best;
  }

  const Model& model_;
  const Adjacency& adjacency_;
  OutOfSight out_of_sight_;
};

double distance2_to_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + share * along - point).squaredNorm();
}

/// Of the free edges at the free-edge node nearest along the surface, the one nearest to the place.
std::optional<FreeEdge> nearest_free_edge(const Model& model, const Sheet& sheet, const ShellSet& start, const Vec3& place) {
  using Reached = std::pair<double, NodeIndex>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  // An entry a node: far quicker than a map where the way to a free edge is long, and a few ms at a million nodes where it is short.
  std::vector<double> distance(model.node_count(), std::numeric_limits<double>::infinity());
  const auto reach = [&](NodeIndex node, double to) {
    if (distance[node.value] <= to) return;
    distance[node.value] = to;
    open.emplace(to, node);
  };
  for (const ShellIndex shell : start)
    for (const NodeIndex node : model.shell(shell).node) reach(node, (model.position(node) - place).norm());
  while (!open.empty()) {
    const auto [to, node] = open.top();
    open.pop();
    if (to > distance[node.value]) continue;
    if (!sheet.is_inner(node)) {
      std::optional<FreeEdge> best;
      double min_distance2 = std::numeric_limits<double>::infinity();
      for (const FreeEdge& edge : sheet.free_edges_at(node)) {
        const double distance2 = distance2_to_segment(place, model.position(edge.from), model.position(edge.to));
        if (distance2 < min_distance2) min_distance2 = distance2, best = edge;
      }
      if (best) return best;
    }
    for (const ShellIndex shell : model.adjacency->shells_of(node)) {
      if (!sheet.has(shell)) continue;
      for (const NodeIndex other : model.shell(shell).node)
        if (other != node) reach(other, to + (model.position(other) - model.position(node)).norm());
    }
  }
  return std::nullopt;
}

void add_midside(const Model& model, const FreeEdge& edge, NodeSet& nodes) {
  const std::vector<MidsideNodes>& all = *model.midside;
  const auto found = std::lower_bound(all.begin(), all.end(), edge.shell, [](const MidsideNodes& m, ShellIndex s) { return m.shell < s; });
  if (found == all.end() || found->shell != edge.shell) return;
  const ShellNodes& shell = model.shell(edge.shell);
  const auto corners = static_cast<std::size_t>(shell.corners());
  for (std::size_t i = 0; i < corners; ++i) {
    const NodeIndex a = shell.node[i], b = shell.node[(i + 1) % corners];
    if (((a == edge.from && b == edge.to) || (a == edge.to && b == edge.from)) && found->node[i].valid()) nodes.push_back(found->node[i]);
  }
}

}  // namespace

NodeSet free_edge_loop(const Model& model, const ShellSet& start, const Vec3& place, OutOfSight out_of_sight) {
  const Sheet sheet(model, out_of_sight);
  NodeSet nodes;
  const std::optional<FreeEdge> first = nearest_free_edge(model, sheet, start, place);
  if (!first) return nodes;
  std::unordered_set<std::uint32_t> seen;  // only looked up
  const FreeEdge backwards{first->edge, first->shell, first->to, first->from};
  for (std::optional<FreeEdge> at : {*first, backwards}) {
    while (at && (seen.insert(at->edge.value).second || at->edge == first->edge)) {
      nodes.push_back(at->from);
      nodes.push_back(at->to);
      add_midside(model, *at, nodes);
      at = sheet.next(*at);
      if (at && at->edge == first->edge) break;  // closed
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace prismesh::mesh::select
