#include "mesh/select/welds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <unordered_set>

#include "mesh/model/adjacency.h"
#include "mesh/select/names.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::select {

namespace {

using Pair = std::pair<ShellIndex, ShellIndex>;

/// Nodes that one element or constraint holds together.
using Ends = std::vector<NodeIndex>;

bool is_weld(std::string_view keyword) {
  for (const std::string_view word : {"CONSTRAINED_SPOTWELD", "CONSTRAINED_GENERALIZED_WELD", "CONSTRAINED_RIVET"})
    if (keyword.starts_with(word)) return true;
  return false;
}

void add_elements(const Model& model, std::vector<Ends>& welds) {
  for (const ElementClass kind :
       {ElementClass::beam, ElementClass::solid, ElementClass::tshell, ElementClass::discrete, ElementClass::other}) {
    const auto& block = model.elements[static_cast<std::size_t>(kind)];
    if (!block) continue;
    for (std::size_t e = 0; e < block->size(); ++e) {
      std::size_t end = block->first_node[e + 1];
      if (kind == ElementClass::beam) end = std::min<std::size_t>(end, block->first_node[e] + 2);  // the third node only orients it
      Ends ends(block->nodes.begin() + block->first_node[e], block->nodes.begin() + static_cast<std::ptrdiff_t>(end));
      std::erase_if(ends, [](NodeIndex node) { return !node.valid(); });
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      if (ends.size() > 1) welds.push_back(std::move(ends));
    }
  }
}

void add_ids(const Model& model, const Reference& reference, Ends& ends) {
  for (std::int64_t id = reference.first; id <= reference.last; id += reference.step) {
    if (const NodeIndex node = model.find_node(id); node.valid()) ends.push_back(node);
    if (ends.size() > 64) return;  // a range, no weld
  }
}

/// Nodes named by one card are one weld; a node set that a card names is one as well.
void add_constraints(const Model& model, const References& references, std::vector<Ends>& welds) {
  const auto referrers = references.referrers();
  std::map<std::pair<std::uint32_t, std::uint64_t>, Ends> by_card;
  for (const Reference& reference : references.all(Referred::node))
    if (is_weld(referrers[reference.referrer].keyword)) add_ids(model, reference, by_card[{reference.referrer, reference.card}]);
  for (auto& [card, ends] : by_card) welds.push_back(std::move(ends));

  std::vector<std::int64_t> wanted;
  for (const Reference& reference : references.all(Referred::node_set))
    if (is_weld(referrers[reference.referrer].keyword)) wanted.push_back(reference.first);
  if (wanted.empty()) return;
  std::sort(wanted.begin(), wanted.end());
  for (const NamedSet& set : find_sets(references)) {
    if (set.kind != Referred::node_set || !std::binary_search(wanted.begin(), wanted.end(), set.id)) continue;
    Ends ends;
    for (const Reference& member : set.members)
      if (member.referred == Referred::node) add_ids(model, member, ends);
    welds.push_back(std::move(ends));
  }
}

double max_edge_length(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double max_edge2 = 0;
  for (std::size_t i = 0; i < 4; ++i)
    max_edge2 = std::max(max_edge2, (model.position(nodes.node[(i + 1) % 4]) - model.position(nodes.node[i])).squaredNorm());
  return std::sqrt(max_edge2);
}

/// A grid of cubes in space; those around some points are marked.
class Cubes {
 public:
  explicit Cubes(double size) : size_(size) {}
  void mark_around(const Vec3& point) {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) marked_.insert(key(along(point.x()) + x, along(point.y()) + y, along(point.z()) + z));
  }
  bool marked(const Vec3& point) const { return marked_.contains(key(along(point.x()), along(point.y()), along(point.z()))); }

 private:
  std::int64_t along(double place) const { return static_cast<std::int64_t>(std::floor(place / size_)); }
  /// Distant cubes may share a key; that costs time only.
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) * 73856093u ^ static_cast<std::uint64_t>(y) * 19349663u << 20 ^
           static_cast<std::uint64_t>(z) * 83492791u << 40;
  }
  double size_;
  std::unordered_set<std::uint64_t> marked_;
};

/// Finds the shells that a weld's end lies on.
class ShellsAtEnds {
 public:
  ShellsAtEnds(const Model& model, OutOfSight out_of_sight, const std::vector<Ends>& welds)
      : model_(model), out_of_sight_(out_of_sight), tree_(model, shells_near_loose_ends(welds)) {}

  ShellSet of(NodeIndex node) const {
    ShellSet at = at_node(node);
    if (!at.empty() || tree_.empty()) return at;
    const auto closest = tree_.closest(model_.position(node), kWeldReach * max_edge_length_);
    if (!closest || closest->distance > kWeldReach * max_edge_length(model_, closest->shell)) return {};
    for (const spatial::SurfacePoint& point :
         tree_.within(model_.position(node), closest->distance + 1e-3 * max_edge_length(model_, closest->shell)))
      at.push_back(point.shell);
    return at;
  }

 private:
  ShellSet at_node(NodeIndex node) const {
    ShellSet shells;
    for (const ShellIndex shell : model_.adjacency->shells_of(node))
      if (in_sight(model_, shell, out_of_sight_)) shells.push_back(shell);
    return shells;
  }
  /// Costs a pass over the shells if any end has no shell at its node.
  ShellSet shells_near_loose_ends(const std::vector<Ends>& welds) {
    NodeSet loose;
    for (const Ends& ends : welds)
      for (const NodeIndex node : ends)
        if (model_.adjacency->shells_of(node).empty()) loose.push_back(node);
    std::sort(loose.begin(), loose.end());
    loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
    ShellSet shells;
    if (loose.empty()) return shells;
    double sum = 0;
    const std::size_t every = model_.shell_count() / 1000 + 1;
    std::size_t count = 0;
    for (std::size_t s = 0; s < model_.shell_count(); s += every)
      if (!model_.is_removed(ShellIndex(s))) sum += max_edge_length(model_, ShellIndex(s)), ++count;
    const double usual = count > 0 ? sum / static_cast<double>(count) : 0;
    if (!(usual > 0)) return shells;
    Cubes cubes(2 * usual);
    for (const NodeIndex node : loose) cubes.mark_around(model_.position(node));
    for (std::size_t s = 0; s < model_.shell_count(); ++s) {
      const ShellIndex shell(s);
      if (!in_sight(model_, shell, out_of_sight_)) continue;
      const ShellNodes& nodes = model_.shell(shell);
      const double max_edge = max_edge_length(model_, shell);
      // a shell not larger than a cube that reaches an end has a corner in this end's cube or one next to it
      const bool near = max_edge * (1 + kWeldReach) > 2 * usual || std::any_of(nodes.node.begin(), nodes.node.end(), [&](NodeIndex node) {
                          return cubes.marked(model_.position(node));
                        });
      if (!near) continue;
      shells.push_back(shell);
      max_edge_length_ = std::max(max_edge_length_, max_edge);
    }
    return shells;
  }

  const Model& model_;
  OutOfSight out_of_sight_;
  double max_edge_length_ = 0;
  spatial::ShellTree tree_;
};

bool touch(const Model& model, const ShellSet& a, const ShellSet& b) {
  for (const ShellIndex shell : a)
    for (const NodeIndex node : model.shell(shell).node)
      for (const ShellIndex other : model.adjacency->shells_of(node))
        if (std::binary_search(b.begin(), b.end(), other)) return true;
  return false;
}

void join(const Model& model, const Ends& ends, const ShellsAtEnds& shells_at_ends, std::vector<Pair>& pairs) {
  std::vector<ShellSet> on;
  for (const NodeIndex node : ends) on.push_back(shells_at_ends.of(node));
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      if (on[i].empty() || on[j].empty() || touch(model, on[i], on[j])) continue;
      double max_edge = 0;
      for (const ShellIndex shell : on[i]) max_edge = std::max(max_edge, max_edge_length(model, shell));
      for (const ShellIndex shell : on[j]) max_edge = std::max(max_edge, max_edge_length(model, shell));
      if ((model.position(ends[i]) - model.position(ends[j])).norm() > kWeldLength * max_edge) continue;
      for (const ShellIndex a : on[i])
        for (const ShellIndex b : on[j]) {
          pairs.emplace_back(a, b);
          pairs.emplace_back(b, a);
        }
    }
}

}  // namespace

WeldedShells::WeldedShells(std::vector<Pair> pairs) : pairs_(std::move(pairs)) {
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
}

std::span<const Pair> WeldedShells::of(ShellIndex shell) const {
  const auto begin = std::lower_bound(pairs_.begin(), pairs_.end(), Pair(shell, ShellIndex(std::size_t{0})));
  auto end = begin;
  while (end != pairs_.end() && end->first == shell) ++end;
  return {begin, end};
}

WeldedShells find_welds(const Model& model, const References* references, OutOfSight out_of_sight) {
  std::vector<Ends> welds;
  add_elements(model, welds);
  if (references != nullptr) add_constraints(model, *references, welds);
  const ShellsAtEnds shells_at_ends(model, out_of_sight, welds);
  std::vector<Pair> pairs;
  for (const Ends& ends : welds) join(model, ends, shells_at_ends, pairs);
  return WeldedShells(std::move(pairs));
}

}  // namespace prismesh::mesh::select
