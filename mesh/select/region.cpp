#include "mesh/select/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/features.h"
#include "mesh/select/crease_lines.h"
#include "mesh/select/fillets.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::select {

namespace {

/// With a width below this share of its length a shell has no reliable plane: rounding of coordinates would decide.
constexpr double kThin = 1.0 / 200;

Vec3 twice_area(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(nodes.node[i]); };
  if (nodes.is_triangle()) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

bool is_thin(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double max_edge2 = 0;
  for (std::size_t i = 0; i < 4; ++i)
    max_edge2 = std::max(max_edge2, (model.position(nodes.node[(i + 1) % 4]) - model.position(nodes.node[i])).squaredNorm());
  return twice_area(model, shell).norm() <= kThin * max_edge2 * (nodes.is_triangle() ? 1 : 2);
}

/// Whether the shell's nodes run from `from` to `to`, not the other way.
bool runs_along(const ShellNodes& nodes, NodeIndex from, NodeIndex to) {
  const auto corners = static_cast<std::size_t>(nodes.corners());
  for (std::size_t i = 0; i < corners; ++i)
    if (nodes.node[i] == from && nodes.node[(i + 1) % corners] == to) return true;
  return false;
}

/// Grows a region over edges, breadth first.
class RegionGrowth {
 public:
  RegionGrowth(const Model& model, const RegionOptions& options)
      : model_(model),
        adjacency_(*model.adjacency),
        options_(options),
        cos_limit_(deterministic_cos_degrees(options.angle_degrees)),
        marks_(model.shell_count(), 0) {
    if (options.bound == RegionBound::features) {
      // nothing bends by more than 180 degrees but a rolled edge
      fillets_.emplace(model, options.angle_degrees < 180 ? options.angle_degrees : std::numeric_limits<double>::infinity(),
                       options.out_of_sight);
      crease_lines_.emplace(model, options.angle_degrees, options.out_of_sight);
    }
    if (options.across != nullptr) node_done_.assign(model.node_count(), 0);
  }

  ShellSet from(const ShellSet& start) {
    for (const ShellIndex shell : start) reach(shell);
    for (std::size_t at = 0; at < found_.size(); ++at) cross_edges_of(found_[at]);
    if (found_.size() < marks_.size() / 32) {
      std::sort(found_.begin(), found_.end());
      return std::move(found_);
    }
    // a large region is quicker to read off its marks
    ShellSet sorted;
    sorted.reserve(found_.size());
    for (std::size_t s = 0; s < marks_.size(); ++s)
      if (marks_[s] != 0) sorted.emplace_back(s);
    return sorted;
  }

 private:
  /// Bits of a shell's entry in marks_. kTurned: its nodes run the other way round than those of the shell at which the region began.
  enum Mark : std::uint8_t { kFound = 1, kTurned = 2, kThinShell = 4 };

  /// Takes a shell as a new start: its orientation relative to the shells before is unknown.
  void reach(ShellIndex shell) {
    if (is_found(shell) || !in_sight(model_, shell, options_.out_of_sight)) return;
    take(shell, kFound | (is_thin(model_, shell) ? kThinShell : 0));
  }
  void take(ShellIndex shell, int marks) {
    marks_[shell.value] = static_cast<std::uint8_t>(marks);
    found_.push_back(shell);
  }
  bool is_found(ShellIndex shell) const { return marks_[shell.value] != 0; }

  void cross_edges_of(ShellIndex shell) {
    const ShellNodes& nodes = model_.shell(shell);
    const auto corners = static_cast<std::size_t>(nodes.corners());
    for (std::size_t i = 0; i < corners; ++i) {
      const NodeIndex from = nodes.node[i], to = nodes.node[(i + 1) % corners];
      if (from != to) cross_edge(shell, from, to);
    }
    if (options_.across == nullptr) return;
    for (const auto& [here, there] : options_.across->of(shell)) reach(there);
    for (std::size_t i = 0; i < corners; ++i) cross_node(nodes.node[i]);
  }

  void cross_edge(ShellIndex shell, NodeIndex from, NodeIndex to) {
    const EdgeIndex edge = adjacency_.find_edge(from, to);
    if (!edge.valid()) return;
    const auto shells = adjacency_.shells_of(edge);
    if (std::all_of(shells.begin(), shells.end(), [&](ShellIndex other) { return is_found(other); })) return;
    ShellIndex beyond;
    std::size_t others = 0;
    for (const ShellIndex other : shells)
      if (other != shell && in_sight(model_, other, options_.out_of_sight)) beyond = other, ++others;
    if (others == 0) return;
    if (options_.bound == RegionBound::piece || (others > 1 && options_.across != nullptr)) {
      for (const ShellIndex other : shells) reach(other);
    } else if (others == 1 && !is_found(beyond)) {
      cross_smoothly(shell, beyond, edge, from, to);
    }
  }

  void cross_smoothly(ShellIndex shell, ShellIndex beyond, EdgeIndex edge, NodeIndex from, NodeIndex to) {
    const bool before_thin = (marks_[shell.value] & kThinShell) != 0, beyond_thin = is_thin(model_, beyond);
    const bool turned = ((marks_[shell.value] & kTurned) != 0) != runs_along(model_.shell(beyond), from, to);
    if (before_thin || beyond_thin) {
      const ShellIndex plane = before_thin ? plane_before(shell) : shell;
      if (beyond_thin) {
        if (plane.valid()) plane_before_.emplace(beyond.value, plane);
      } else if (plane.valid() && folded_beyond_thin(plane, beyond, turned)) {
        return;
      }
    } else if (is_bound(shell, beyond, edge, from < to ? Edge{from, to} : Edge{to, from})) {
      return;
    }
    take(beyond, kFound | (turned ? kTurned : 0) | (beyond_thin ? kThinShell : 0));
  }

  /// The last shell with a plane before a thin one; invalid if there was none.
  ShellIndex plane_before(ShellIndex thin) const {
    const auto found = plane_before_.find(thin.value);
    return found == plane_before_.end() ? ShellIndex() : found->second;
  }

  bool is_bound(ShellIndex shell, ShellIndex beyond, EdgeIndex edge, Edge ends) {
    if (options_.bound == RegionBound::creases) return mesh::is_crease(model_, shell, beyond, ends, cos_limit_);
    const bool in_fillet = fillets_->directions(shell) != 0;
    if (in_fillet != (fillets_->directions(beyond) != 0)) return true;
    // edges inside a fillet may be sharp by themselves
    if (in_fillet && fillets_->bends_across(shell, ends) && fillets_->bends_across(beyond, ends)) return false;
    return crease_lines_->is_crease(edge, ends, shell, beyond);
  }

  /// Compares the shells before and behind thin ones. The thin shells have no plane, but the order of their nodes carries the orientation.
  bool folded_beyond_thin(ShellIndex plane, ShellIndex beyond, bool turned) const {
    const bool plane_turned = (marks_[plane.value] & kTurned) != 0;
    const Vec3 before = twice_area(model_, plane), after = twice_area(model_, beyond);
    const double same = before.dot(after) * (plane_turned == turned ? 1 : -1);
    return same < cos_limit_ * std::sqrt(before.squaredNorm() * after.squaredNorm());
  }

  /// Takes the shells of other sheets that share the node but no edge at it.
  void cross_node(NodeIndex node) {
    if (node_done_[node.value] != 0) return;
    node_done_[node.value] = 1;
    ShellSet connected, rest;
    for (const ShellIndex shell : adjacency_.shells_of(node))
      if (in_sight(model_, shell, options_.out_of_sight)) (connected.empty() ? connected : rest).push_back(shell);
    for (std::size_t at = 0; at < connected.size() && !rest.empty(); ++at)
      for (const NodeIndex other : model_.shell(connected[at]).node) {
        const EdgeIndex edge = other == node ? EdgeIndex() : adjacency_.find_edge(node, other);
        if (!edge.valid()) continue;
        for (const ShellIndex beside : adjacency_.shells_of(edge))
          if (std::erase(rest, beside) > 0) connected.push_back(beside);
      }
    if (rest.empty()) return;
    for (const ShellIndex shell : adjacency_.shells_of(node)) {
      // all shells of the other sheet at the node, as at a start on a crease
      const bool other_sheet = std::find(rest.begin(), rest.end(), shell) != rest.end();
      const bool came_from_rest = std::any_of(rest.begin(), rest.end(), [&](ShellIndex s) { return is_found(s); });
      if (other_sheet != came_from_rest) reach(shell);
    }
  }

  const Model& model_;
  const Adjacency& adjacency_;
  const RegionOptions& options_;
  double cos_limit_;
  std::optional<Fillets> fillets_;  ///< for bound features
  std::optional<CreaseLines> crease_lines_;
  std::vector<std::uint8_t> marks_;
  std::vector<std::uint8_t> node_done_;
  std::unordered_map<std::uint32_t, ShellIndex> plane_before_;  ///< only looked up
  ShellSet found_;
};

/// Shells of the parts of `start`; with welds also those of all parts that are joined to them, directly or through others.
ShellSet region_of_parts(const Model& model, const ShellSet& start, const RegionOptions& options) {
  std::vector<std::uint8_t> taken(model.parts->size() + 1, 0);  // the last: shells without a part
  const auto place = [&](ShellIndex shell) {
    const PartIndex part = model.shell_parts[shell.value];
    return part.valid() ? std::size_t{part.value} : model.parts->size();
  };
  for (const ShellIndex shell : start) taken[place(shell)] = 1;
  if (options.across != nullptr) {
    std::vector<std::pair<std::size_t, std::size_t>> joined;
    for (const auto& [a, b] : options.across->all())
      if (place(a) != place(b)) joined.emplace_back(place(a), place(b));
    for (std::size_t n = 0; n < model.node_count(); ++n) {
      ShellIndex first;
      for (const ShellIndex shell : model.adjacency->shells_of(NodeIndex(n))) {
        if (!in_sight(model, shell, options.out_of_sight)) continue;
        if (first.valid() && place(first) != place(shell)) {
          joined.emplace_back(place(first), place(shell));
          joined.emplace_back(place(shell), place(first));
        }
        if (!first.valid()) first = shell;
      }
    }
    std::sort(joined.begin(), joined.end());
    joined.erase(std::unique(joined.begin(), joined.end()), joined.end());
    for (bool more = true; more;) {
      more = false;
      for (const auto& [a, b] : joined)
        if (taken[a] != 0 && taken[b] == 0) taken[b] = 1, more = true;
    }
  }
  ShellSet shells;
  for (std::size_t s = 0; s < model.shell_count(); ++s)
    if (in_sight(model, ShellIndex(s), options.out_of_sight) && taken[place(ShellIndex(s))] != 0) shells.emplace_back(s);
  return shells;
}

/// Squares of a point's distances from the box around a shell's corners and from its nearest corner.
std::pair<double, double> distances2(const Model& model, ShellIndex shell, const Vec3& point) {
  const ShellNodes& nodes = model.shell(shell);
  Vec3 low = model.position(nodes.node[0]), high = low;
  double corner2 = std::numeric_limits<double>::infinity();
  for (const NodeIndex node : nodes.node) {
    const Vec3& at = model.position(node);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    corner2 = std::min(corner2, (at - point).squaredNorm());
  }
  return {(low - point).cwiseMax(point - high).cwiseMax(Vec3::Zero()).squaredNorm(), corner2};
}

ShellSet without(const ShellSet& all, const ShellSet& some) {
  ShellSet rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

template <class IndexType>
std::vector<IndexType> united(const std::vector<IndexType>& a, const std::vector<IndexType>& b) {
  std::vector<IndexType> both;
  both.reserve(a.size() + b.size());
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

ShellSet touching(const Model& model, const NodeSet& nodes, OutOfSight out_of_sight) {
  ShellSet shells = shells_touching(model, nodes);
  std::erase_if(shells, [&](ShellIndex shell) { return !in_sight(model, shell, out_of_sight); });
  return shells;
}

}  // namespace

ShellSet region(const Model& model, const ShellSet& start, const RegionOptions& options) {
  if (options.bound == RegionBound::part) return region_of_parts(model, start, options);
  return RegionGrowth(model, options).from(start);
}

ShellSet shells_at(const Model& model, NodeIndex node, OutOfSight out_of_sight) {
  ShellSet shells;
  if (node.value >= model.node_count()) return shells;
  for (const ShellIndex shell : model.adjacency->shells_of(node))
    if (in_sight(model, shell, out_of_sight)) shells.push_back(shell);
  return shells;
}

ShellSet shells_near(const Model& model, const Vec3& point, OutOfSight out_of_sight) {
  constexpr std::size_t kGrain = 16384;
  const std::size_t ranges = (model.shell_count() + kGrain - 1) / kGrain;
  // the closest shell isn't farther than the nearest corner: only shells whose boxes come as near are candidates
  std::vector<double> nearest2(ranges, std::numeric_limits<double>::infinity());
  parallel_for(model.shell_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (in_sight(model, ShellIndex(s), out_of_sight))
        nearest2[begin / kGrain] = std::min(nearest2[begin / kGrain], distances2(model, ShellIndex(s), point).second);
  });
  const double reach2 = ranges > 0 ? 1.01 * *std::min_element(nearest2.begin(), nearest2.end()) : 0;
  std::vector<ShellSet> of_range(ranges);
  parallel_for(model.shell_count(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (in_sight(model, ShellIndex(s), out_of_sight) && distances2(model, ShellIndex(s), point).first <= reach2)
        of_range[begin / kGrain].emplace_back(s);
  });
  ShellSet close;
  for (const ShellSet& some : of_range) close.insert(close.end(), some.begin(), some.end());
  const spatial::ShellTree tree(model, close);
  const auto closest = tree.closest(point);
  ShellSet shells;
  if (!closest) return shells;
  const ShellNodes& nodes = model.shell(closest->shell);
  double max_edge2 = 0;
  for (std::size_t i = 0; i < 4; ++i)
    max_edge2 = std::max(max_edge2, (model.position(nodes.node[(i + 1) % 4]) - model.position(nodes.node[i])).squaredNorm());
  for (const spatial::SurfacePoint& found : tree.within(point, closest->distance + 1e-3 * std::sqrt(max_edge2)))
    shells.push_back(found.shell);
  return shells;
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
        if (closer(candidate, of_range[c]) && !model.is_removed(candidate.node)) of_range[c] = candidate;
      }
    }
  });
  Nearest best;
  for (const Nearest& candidate : of_range)
    if (closer(candidate, best)) best = candidate;
  return best.node;
}

NodeSet grow(const Model& model, const NodeSet& nodes, int rings, OutOfSight out_of_sight) {
  NodeSet grown = nodes;
  for (int ring = 0; ring < rings; ++ring) {
    NodeSet both = united(grown, nodes_of(model, touching(model, grown, out_of_sight)));
    if (both.size() == grown.size()) break;
    grown = std::move(both);
  }
  return grown;
}

NodeSet shrink(const Model& model, const NodeSet& nodes, int rings, OutOfSight out_of_sight) {
  NodeSet left = nodes;
  for (int ring = 0; ring < rings && !left.empty(); ++ring) {
    const NodeSet rim = nodes_of(model, without(touching(model, left, out_of_sight), shells_inside(model, left)));
    NodeSet inner;
    std::set_difference(left.begin(), left.end(), rim.begin(), rim.end(), std::back_inserter(inner));
    if (inner.size() == left.size()) break;
    left = std::move(inner);
  }
  return left;
}

ShellSet grow_shells(const Model& model, const ShellSet& shells, int rings, OutOfSight out_of_sight) {
  ShellSet grown = shells;
  for (int ring = 0; ring < rings; ++ring) {
    ShellSet both = united(grown, touching(model, nodes_of(model, grown), out_of_sight));
    if (both.size() == grown.size()) break;
    grown = std::move(both);
  }
  return grown;
}

ShellSet shrink_shells(const Model& model, const ShellSet& shells, int rings, OutOfSight out_of_sight) {
  ShellSet left = shells;
  for (int ring = 0; ring < rings && !left.empty(); ++ring) {
    const ShellSet outside = without(touching(model, nodes_of(model, left), out_of_sight), left);
    ShellSet inner = without(left, shells_touching(model, nodes_of(model, outside)));
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
    else if (!model.is_removed(NodeIndex(i)))
      rest.push_back(NodeIndex(i));
  }
  return rest;
}

}  // namespace prismesh::mesh::select
