#include "mesh/contact/pair_regions.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "mesh/contact/sort_unique.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

/// A pair as seen from one of its shells.
struct SeenFrom {
  ShellIndex own, other;
  PartIndex part_own, part_other;
  std::uint32_t pair = 0;
  bool swapped = false;  ///< own is the pair's shell b; only in one part
};

std::vector<SeenFrom> seen_from_own(std::span<const SidedPair> pairs) {
  std::vector<SeenFrom> seen;
  seen.reserve(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto number = static_cast<std::uint32_t>(p);
    seen.push_back({pairs[p].a, pairs[p].b, pairs[p].part_a, pairs[p].part_b, number, false});
    if (pairs[p].part_a == pairs[p].part_b) seen.push_back({pairs[p].b, pairs[p].a, pairs[p].part_b, pairs[p].part_a, number, true});
  }
  std::sort(seen.begin(), seen.end(),
            [](const SeenFrom& x, const SeenFrom& y) { return std::tie(x.own, x.pair) < std::tie(y.own, y.pair); });
  return seen;
}

/// Which pairs belong to which region: a forest over pairs, each with whether its sides are those of its root swapped.
class Regions {
 public:
  explicit Regions(std::size_t pairs) : parent_(pairs), swapped_(pairs, false) {
    for (std::size_t p = 0; p < pairs; ++p) parent_[p] = static_cast<std::uint32_t>(p);
  }
  InRegion root(std::uint32_t pair) {
    bool swapped = false;
    std::uint32_t at = pair;
    for (; parent_[at] != at; at = parent_[at]) swapped = swapped != swapped_[at];
    for (bool left = swapped; parent_[pair] != at;) {  // shortens the way
      const std::uint32_t next = parent_[pair];
      const bool left_after = left != swapped_[pair];
      parent_[pair] = at, swapped_[pair] = left;
      left = left_after, pair = next;
    }
    return {at, swapped};
  }
  /// The root is always the region's lowest pair.
  void join(std::uint32_t a, std::uint32_t b, bool swapped) {
    auto [root_a, swapped_a] = root(a);
    auto [root_b, swapped_b] = root(b);
    if (root_a == root_b) return;
    if (root_b < root_a) std::swap(root_a, root_b);
    parent_[root_b] = root_a;
    swapped_[root_b] = (swapped != swapped_a) != swapped_b;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<bool> swapped_;
};

}  // namespace

SidedPair in_order_of_parts(const Model& model, ShellIndex a, ShellIndex b) {
  SidedPair pair{a, b, model.shell_parts[a.value], model.shell_parts[b.value]};
  if (pair.part_b < pair.part_a) std::swap(pair.a, pair.b), std::swap(pair.part_a, pair.part_b);
  return pair;
}

std::vector<InRegion> find_regions(const Model& model, std::span<const SidedPair> pairs) {
  const std::vector<SeenFrom> seen = seen_from_own(pairs);
  std::vector<NodeIndex> nodes;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (i == 0 || seen[i].own != seen[i - 1].own)
      for (const NodeIndex node : model.shell(seen[i].own).node) nodes.push_back(node);
  sort_unique(nodes);
  // Node by node, so that the lists to sort stay short: pairs with a common node of each side belong together.
  struct AtNode {
    PartIndex part_own, part_other;
    NodeIndex of_other;
    std::uint32_t pair;
    bool swapped;
    auto key() const { return std::tie(part_own, part_other, of_other); }
  };
  Regions regions(pairs.size());
  std::vector<AtNode> at_node;
  for (const NodeIndex node : nodes) {
    at_node.clear();
    for (const ShellIndex own : model.adjacency->shells_of(node)) {
      auto at = std::lower_bound(seen.begin(), seen.end(), own, [](const SeenFrom& x, ShellIndex shell) { return x.own < shell; });
      for (; at != seen.end() && at->own == own; ++at) {
        const ShellNodes& other = model.shell(at->other);
        for (int i = 0; i < other.corners(); ++i)
          at_node.push_back({at->part_own, at->part_other, other.node[static_cast<std::size_t>(i)], at->pair, at->swapped});
      }
    }
    std::sort(at_node.begin(), at_node.end(), [](const AtNode& x, const AtNode& y) {
      return std::tie(x.part_own, x.part_other, x.of_other, x.pair) < std::tie(y.part_own, y.part_other, y.of_other, y.pair);
    });
    for (std::size_t i = 1; i < at_node.size(); ++i)
      if (at_node[i].key() == at_node[i - 1].key())
        regions.join(at_node[i - 1].pair, at_node[i].pair, at_node[i].swapped != at_node[i - 1].swapped);
  }
  std::vector<InRegion> of_pair;
  of_pair.reserve(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) of_pair.push_back(regions.root(static_cast<std::uint32_t>(p)));
  return of_pair;
}

}  // namespace prismesh::mesh::contact
