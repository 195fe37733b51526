#include "mesh/quality/structure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/quality/triangle_clusters.h"

namespace prismesh::mesh::quality {

namespace {

constexpr std::size_t kStructureGrain = 16384;
constexpr std::size_t kSmallLoop = 4;  ///< edges: what one missing shell leaves

/// The shells to check.
class Scope {
 public:
  Scope(const Model& model, const ShellSet* shells) : all_(shells == nullptr) {
    if (all_) return;
    in_.assign(model.shell_count(), 0);
    for (const ShellIndex shell : *shells) in_[shell.value] = 1;
  }
  bool has(ShellIndex shell) const { return all_ || in_[shell.value] != 0; }
  bool any(std::span<const ShellIndex> shells) const {
    return std::any_of(shells.begin(), shells.end(), [&](ShellIndex shell) { return has(shell); });
  }

 private:
  bool all_;
  std::vector<std::uint8_t> in_;
};

/// The indices of [0, count) for which `is` returns true, ascending. Calls `is` in parallel.
template <class IndexType, class Is>
std::vector<IndexType> all_of(std::size_t count, const Is& is) {
  std::vector<std::vector<IndexType>> found((count + kStructureGrain - 1) / kStructureGrain);
  parallel_for(count, kStructureGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is(IndexType(i))) found[begin / kStructureGrain].push_back(IndexType(i));
  });
  std::vector<IndexType> list;
  for (const std::vector<IndexType>& part : found) list.insert(list.end(), part.begin(), part.end());
  return list;
}

/// The lower end of every edge: Adjacency::edge() would have to search.
std::vector<NodeIndex> low_ends(const Adjacency& adjacency) {
  std::vector<NodeIndex> low(adjacency.edge_count());
  for (std::size_t n = 0; n + 1 < adjacency.edge_first.size(); ++n)
    for (std::size_t e = adjacency.edge_first[n]; e < adjacency.edge_first[n + 1]; ++e) low[e] = NodeIndex(n);
  return low;
}

/// The different corners, ascending; then invalid ones.
std::array<NodeIndex, 4> corner_set(const ShellNodes& shell) {
  std::array<NodeIndex, 4> corners = shell.node;
  std::sort(corners.begin(), corners.end());
  std::fill(std::unique(corners.begin(), corners.end()), corners.end(), NodeIndex());
  return corners;
}

bool is_duplicate(const Model& model, ShellIndex shell) {
  if (model.is_removed(shell)) return false;
  const std::array<NodeIndex, 4> corners = corner_set(model.shell(shell));
  const std::span<const ShellIndex> around = model.adjacency->shells_of(corners[0]);
  return std::any_of(around.begin(), around.end(),
                     [&](ShellIndex other) { return other < shell && corner_set(model.shell(other)) == corners; });
}

/// How often a shell has an edge in the direction from low to high, and from high to low.
std::array<int, 2> runs(const ShellNodes& shell, NodeIndex low, NodeIndex high) {
  std::array<int, 2> along{};
  const auto corners = static_cast<std::size_t>(shell.corners());
  for (std::size_t i = 0; i < corners; ++i) {
    const NodeIndex from = shell.node[i], to = shell.node[(i + 1) % corners];
    along[0] += from == low && to == high;
    along[1] += from == high && to == low;
  }
  return along;
}

bool is_opposed(const Model& model, EdgeIndex edge, NodeIndex low) {
  const std::span<const ShellIndex> shells = model.adjacency->shells_of(edge);
  if (shells.size() != 2) return false;
  const NodeIndex high = model.adjacency->edge_high[edge.value];
  const std::array<int, 2> a = runs(model.shell(shells[0]), low, high), b = runs(model.shell(shells[1]), low, high);
  // a shell that has the edge twice has no direction there
  return a[0] + a[1] == 1 && b[0] + b[1] == 1 && a == b;
}

/// The free edges, found by end or by position.
class FreeEdges {
 public:
  FreeEdges(const Model& model, const std::vector<NodeIndex>& low, double tolerance) : model_(model), low_(low), tolerance_(tolerance) {
    const Adjacency& adjacency = *model.adjacency;
    const auto is_free = [&](EdgeIndex e) { return adjacency.shells_of(e).size() == 1; };
    for (const EdgeIndex edge : all_of<EdgeIndex>(adjacency.edge_count(), is_free)) {
      FreeEdge entry{edge, part_of(edge), point(low[edge.value]), point(adjacency.edge_high[edge.value])};
      entry.reach = tolerance * entry.length();
      if (!std::isfinite(entry.reach) || !(entry.reach > 0)) continue;
      edges_.push_back(entry);
      ends_.push_back({low[edge.value], edges_.size() - 1});
      ends_.push_back({adjacency.edge_high[edge.value], edges_.size() - 1});
    }
    std::sort(ends_.begin(), ends_.end());
    for (std::size_t i = 0; i < edges_.size(); ++i) cells_.push_back({place(i, level_of(edges_[i].length()), {0, 0, 0}), i});
    std::sort(cells_.begin(), cells_.end());
  }

  std::size_t size() const { return edges_.size(); }
  EdgeIndex edge(std::size_t i) const { return edges_[i].edge; }

  /// Another free edge of the part lies where this one does, or two that meet on it do.
  bool is_unjoined(std::size_t i) const { return has_twin(i) || spans_two(i) || is_spanned(i); }

  /// On a loop of no more edges than a shell has.
  bool is_on_small_loop(std::size_t i) const {
    std::vector<std::size_t> loop = {i};
    return closes(loop, other_end(i, low_[edge(i).value]), low_[edge(i).value]);
  }

 private:
  /// Part, level, and the cell of the middle. Edges of about one length are on one level, so that a long one doesn't make the short ones'
  /// cells large.
  using CellKey = std::tuple<std::uint32_t, int, std::int64_t, std::int64_t, std::int64_t>;
  struct FreeEdge {
    EdgeIndex edge;
    PartIndex part;
    Vec3 a, b;
    double reach = 0;
    double length() const { return (b - a).norm(); }
  };
  using EdgeEnd = std::pair<NodeIndex, std::size_t>;

  const Vec3& point(NodeIndex node) const { return model_.position(node); }
  PartIndex part_of(EdgeIndex edge) const { return model_.shell_parts[model_.adjacency->shells_of(edge)[0].value]; }

  /// Edges of a level are between half a power of two and that power long.
  static int level_of(double length) {
    int level = 0;
    std::frexp(length, &level);
    return level;
  }

  CellKey place(std::size_t i, int level, const std::array<int, 3>& shift) const {
    const FreeEdge& e = edges_[i];
    const double size = 2 * tolerance_ * std::ldexp(1.0, level);  // no less than twice what any edge of the level reaches
    std::array<std::int64_t, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const double cell = std::floor(0.5 * (e.a[axis] + e.b[axis]) / size);
      at[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::clamp(cell, -9e17, 9e17)) + shift[static_cast<std::size_t>(axis)];
    }
    return {e.part.value, level, at[0], at[1], at[2]};
  }

  /// A twin is as long, but for what both ends may be apart.
  bool has_twin(std::size_t i) const {
    const double length = edges_[i].length(), apart = 1 + 2 * tolerance_;
    for (int level = level_of(length / apart); level <= level_of(length * apart); ++level)
      if (has_twin(i, level)) return true;
    return false;
  }

  bool has_twin(std::size_t i, int level) const {
    const FreeEdge& e = edges_[i];
    std::array<int, 3> shift{};
    for (shift[0] = -1; shift[0] <= 1; ++shift[0])
      for (shift[1] = -1; shift[1] <= 1; ++shift[1])
        for (shift[2] = -1; shift[2] <= 1; ++shift[2]) {
          const CellKey at = place(i, level, shift);
          for (auto it = std::lower_bound(cells_.begin(), cells_.end(), std::pair(at, std::size_t{0}));
               it != cells_.end() && it->first == at; ++it) {
            if (it->second == i) continue;
            const FreeEdge& o = edges_[it->second];
            const double reach = std::min(e.reach, o.reach);
            const auto near = [reach](const Vec3& p, const Vec3& q) { return (p - q).norm() <= reach; };
            if ((near(e.a, o.a) && near(e.b, o.b)) || (near(e.a, o.b) && near(e.b, o.a))) return true;
          }
        }
    return false;
  }

  std::span<const EdgeEnd> at(NodeIndex node) const {
    const auto first = std::lower_bound(ends_.begin(), ends_.end(), EdgeEnd{node, 0});
    auto last = first;
    while (last != ends_.end() && last->first == node) ++last;
    return {first, last};
  }
  NodeIndex other_end(std::size_t i, NodeIndex node) const {
    const NodeIndex low = low_[edge(i).value];
    return low == node ? model_.adjacency->edge_high[edge(i).value] : low;
  }

  /// The node between lies on the long edge.
  bool lies_on(NodeIndex between, const FreeEdge& e) const {
    const Vec3 along = e.b - e.a, to = point(between) - e.a;
    const double share = to.dot(along) / along.squaredNorm();
    return share > 0 && share < 1 && (to - share * along).norm() <= e.reach;
  }
  /// Two free edges lead from end to end of edge i, over a node that lies on it.
  bool spans_two(std::size_t i) const {
    const NodeIndex a = low_[edge(i).value], b = other_end(i, a);
    for (const EdgeEnd& first : at(a)) {
      if (first.second == i || edges_[first.second].part != edges_[i].part) continue;
      const NodeIndex between = other_end(first.second, a);
      for (const EdgeEnd& second : at(between))
        if (second.second != first.second && edges_[second.second].part == edges_[i].part && other_end(second.second, between) == b &&
            lies_on(between, edges_[i]))
          return true;
    }
    return false;
  }
  /// The other way: edge i is one of two that lie on a long one.
  bool is_spanned(std::size_t i) const {
    const NodeIndex a = low_[edge(i).value], b = other_end(i, a);
    for (const NodeIndex between : {a, b}) {
      const NodeIndex end = between == a ? b : a;
      for (const EdgeEnd& next : at(between)) {
        if (next.second == i || edges_[next.second].part != edges_[i].part) continue;
        const NodeIndex far = other_end(next.second, between);
        for (const EdgeEnd& over : at(end))
          if (over.second != i && edges_[over.second].part == edges_[i].part && other_end(over.second, end) == far &&
              lies_on(between, edges_[over.second]))
            return true;
      }
    }
    return false;
  }

  bool closes(std::vector<std::size_t>& loop, NodeIndex at_node, NodeIndex goal) const {
    for (const EdgeEnd& next : at(at_node)) {
      if (edges_[next.second].part != edges_[loop[0]].part || std::find(loop.begin(), loop.end(), next.second) != loop.end()) continue;
      const NodeIndex to = other_end(next.second, at_node);
      loop.push_back(next.second);
      if (to == goal) {
        if (!is_border_of_piece(loop)) return true;
      } else if (loop.size() < kSmallLoop && closes(loop, to, goal)) {
        return true;
      }
      loop.pop_back();
    }
    return false;
  }
  /// The loop runs about the shells, not about a hole among them: they have no corner off it, or lie on its inner side.
  bool is_border_of_piece(const std::vector<std::size_t>& loop) const {
    const auto on_loop = [&](NodeIndex node) {
      return std::any_of(loop.begin(), loop.end(),
                         [&](std::size_t i) { return low_[edge(i).value] == node || model_.adjacency->edge_high[edge(i).value] == node; });
    };
    const bool all_on_loop = std::all_of(loop.begin(), loop.end(), [&](std::size_t i) {
      const ShellNodes& shell = shell_at(i);
      return std::all_of(shell.node.begin(), shell.node.end(), on_loop);
    });
    Vec3 centre = Vec3::Zero();
    for (const std::size_t i : loop) centre += 0.5 * (edges_[i].a + edges_[i].b) / static_cast<double>(loop.size());
    return all_on_loop || std::all_of(loop.begin(), loop.end(), [&](std::size_t i) { return lies_towards(i, centre); });
  }
  const ShellNodes& shell_at(std::size_t i) const { return model_.shell(model_.adjacency->shells_of(edge(i))[0]); }
  /// The shell at an edge lies from it in about the direction of a point.
  bool lies_towards(std::size_t i, const Vec3& to) const {
    const Vec3 along = edges_[i].b - edges_[i].a;
    const auto away = [&](const Vec3& p) {
      const Vec3 from = p - edges_[i].a;
      return Vec3(from - from.dot(along) / along.squaredNorm() * along);
    };
    Vec3 centre = Vec3::Zero();
    for (const NodeIndex node : shell_at(i).node) centre += 0.25 * point(node);
    const Vec3 own = away(centre), wanted = away(to);
    return own.dot(wanted) > 0.5 * own.norm() * wanted.norm();
  }

  const Model& model_;
  const std::vector<NodeIndex>& low_;
  std::vector<FreeEdge> edges_;
  std::vector<EdgeEnd> ends_;  ///< by node
  std::vector<std::pair<CellKey, std::size_t>> cells_;
  double tolerance_ = 0;
};

void find_free_inside(const Model& model, const std::vector<NodeIndex>& low, const Scope& scope, double tolerance, Structure& found) {
  const FreeEdges free(model, low, tolerance);
  std::vector<std::uint8_t> kind(free.size());
  parallel_for(free.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (scope.any(model.adjacency->shells_of(free.edge(i)))) kind[i] = free.is_unjoined(i) ? 2 : free.is_on_small_loop(i) ? 1 : 0;
  });
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (kind[i] == 2) found.unjoined.push_back(free.edge(i));
    if (kind[i] == 1) found.free_inside.push_back(free.edge(i));
  }
}

/// Max number of triangles at a node, those of meshes of triangles included.
void find_max_triangles(const Model& model, const Scope& scope, Structure& found) {
  std::vector<std::uint32_t> triangles(model.node_count());
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const ShellNodes& shell = model.shell_nodes[s];
    if (!shell.node[0].valid() || !shell.is_triangle() || !scope.has(ShellIndex(s))) continue;
    for (const NodeIndex corner : corner_set(shell))
      if (corner.valid()) ++triangles[corner.value];
  }
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    if (triangles[n] <= found.max_triangles) continue;
    found.max_triangles = triangles[n];
    found.max_triangles_at = NodeIndex(n);
  }
}

}  // namespace

Structure check_structure(const Model& model, const StructureOptions& options, const ShellSet* shells) {
  const Adjacency& adjacency = *model.adjacency;
  const Scope scope(model, shells);
  const std::vector<NodeIndex> low = low_ends(adjacency);
  Structure found;
  found.duplicates = all_of<ShellIndex>(model.shell_count(), [&](ShellIndex s) { return scope.has(s) && is_duplicate(model, s); });
  found.opposed = all_of<EdgeIndex>(adjacency.edge_count(),
                                    [&](EdgeIndex e) { return scope.any(adjacency.shells_of(e)) && is_opposed(model, e, low[e.value]); });
  found.multiple = all_of<EdgeIndex>(adjacency.edge_count(),
                                     [&](EdgeIndex e) { return adjacency.shells_of(e).size() > 2 && scope.any(adjacency.shells_of(e)); });
  find_free_inside(model, low, scope, options.tolerance, found);
  for (const TriangleCluster& cluster : find_triangle_clusters(model, options.triangles_at_node, shells))
    found.clusters.push_back(cluster.node);
  find_max_triangles(model, scope, found);
  return found;
}

}  // namespace prismesh::mesh::quality
