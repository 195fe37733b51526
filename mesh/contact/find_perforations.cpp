#include "mesh/contact/find_perforations.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "mesh/contact/sort_unique.h"

namespace prismesh::mesh::contact {

namespace {

/// A node of each side of a pair of shells; pairs with the same nodes belong together.
struct NodesOfSides {
  PartIndex part_a, part_b;
  NodeIndex a, b;
  std::uint32_t pair = 0;
  bool swapped = false;  ///< in one part, where the pair doesn't say which fold is side a

  auto key() const { return std::tuple(part_a, part_b, a, b); }
};

struct SidedPair {
  ShellIndex a, b;
  PartIndex part_a, part_b;
};

std::vector<SidedPair> in_order_of_parts(const Model& model, const std::vector<ShellCrossing>& crossings) {
  std::vector<SidedPair> pairs;
  pairs.reserve(crossings.size());
  for (const ShellCrossing& crossing : crossings) {
    SidedPair pair{crossing.a, crossing.b, model.shell_parts[crossing.a.value], model.shell_parts[crossing.b.value]};
    if (pair.part_b < pair.part_a) std::swap(pair.a, pair.b), std::swap(pair.part_a, pair.part_b);
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<NodesOfSides> nodes_of_sides(const Model& model, const std::vector<SidedPair>& pairs) {
  std::vector<NodesOfSides> entries;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const SidedPair& pair = pairs[p];
    const ShellNodes& of_a = model.shell(pair.a);
    const ShellNodes& of_b = model.shell(pair.b);
    for (int i = 0; i < of_a.corners(); ++i)
      for (int j = 0; j < of_b.corners(); ++j) {
        NodesOfSides entry{pair.part_a,
                           pair.part_b,
                           of_a.node[static_cast<std::size_t>(i)],
                           of_b.node[static_cast<std::size_t>(j)],
                           static_cast<std::uint32_t>(p),
                           false};
        if (pair.part_a == pair.part_b && entry.b < entry.a) std::swap(entry.a, entry.b), entry.swapped = true;
        entries.push_back(entry);
      }
  }
  std::sort(entries.begin(), entries.end(),
            [](const NodesOfSides& x, const NodesOfSides& y) { return std::tuple(x.key(), x.pair) < std::tuple(y.key(), y.pair); });
  return entries;
}

/// Which pairs belong to which region: a forest over pairs, each with whether its sides are those of its root swapped.
class Regions {
 public:
  explicit Regions(std::size_t pairs) : parent_(pairs), swapped_(pairs, false) {
    for (std::size_t p = 0; p < pairs; ++p) parent_[p] = static_cast<std::uint32_t>(p);
  }
  std::pair<std::uint32_t, bool> root(std::uint32_t pair) {
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

auto coordinates(const CurveSegment& s) { return std::tuple(s.from.x(), s.from.y(), s.from.z(), s.to.x(), s.to.y(), s.to.z()); }

/// Counts a segment once that several pairs of shells have.
void finish(Perforation& region) {
  std::sort(region.crossings.begin(), region.crossings.end());
  for (const auto& [a, b] : region.crossings) region.shells_a.push_back(a), region.shells_b.push_back(b);
  sort_unique(region.shells_a);
  sort_unique(region.shells_b);
  for (CurveSegment& s : region.curve)
    if (std::tuple(s.to.x(), s.to.y(), s.to.z()) < std::tuple(s.from.x(), s.from.y(), s.from.z())) std::swap(s.from, s.to);
  const auto less = [](const CurveSegment& x, const CurveSegment& y) { return coordinates(x) < coordinates(y); };
  const auto equal = [](const CurveSegment& x, const CurveSegment& y) { return coordinates(x) == coordinates(y); };
  std::sort(region.curve.begin(), region.curve.end(), less);
  region.curve.erase(std::unique(region.curve.begin(), region.curve.end(), equal), region.curve.end());
  for (const CurveSegment& segment : region.curve) region.length += segment.length();
}

}  // namespace

std::vector<Perforation> group_crossings(const Model& model, const std::vector<ShellCrossing>& crossings) {
  const std::vector<SidedPair> pairs = in_order_of_parts(model, crossings);
  const std::vector<NodesOfSides> entries = nodes_of_sides(model, pairs);
  Regions regions(pairs.size());
  for (std::size_t e = 1; e < entries.size(); ++e)
    if (entries[e].key() == entries[e - 1].key())
      regions.join(entries[e - 1].pair, entries[e].pair, entries[e].swapped != entries[e - 1].swapped);

  std::vector<Perforation> found;
  std::vector<std::uint32_t> of_root(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [root, swapped] = regions.root(static_cast<std::uint32_t>(p));
    if (root == p) {
      of_root[p] = static_cast<std::uint32_t>(found.size());
      found.push_back({pairs[p].part_a, pairs[p].part_b, {}, {}, {}, {}, 0});
    }
    Perforation& region = found[of_root[root]];
    region.crossings.emplace_back(swapped ? pairs[p].b : pairs[p].a, swapped ? pairs[p].a : pairs[p].b);
    region.curve.insert(region.curve.end(), crossings[p].segments.begin(), crossings[p].segments.end());
  }
  for (Perforation& region : found) finish(region);
  std::sort(found.begin(), found.end(), [](const Perforation& x, const Perforation& y) {
    return std::tuple(-x.length, x.part_a, x.part_b, x.shells_a, x.shells_b) <
           std::tuple(-y.length, y.part_a, y.part_b, y.shells_a, y.shells_b);
  });
  return found;
}

std::vector<Perforation> find_perforations(const Model& model, const spatial::BoxTree& tree) {
  return group_crossings(model, find_shell_crossings(model, tree));
}

}  // namespace prismesh::mesh::contact
