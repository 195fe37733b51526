#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel_for.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::size_t kSubtrees = 64;  ///< subtrees that are built at once
constexpr std::size_t kBoxGrain = 8192;

/// A shell while the tree is built: these are sorted.
struct BoxEntry {
  std::array<float, 3> middle;
  std::uint32_t shell;  ///< ties by it make the tree the same wherever it is built
};
using Entries = std::vector<BoxEntry>;

/// A range of entries that becomes a node.
struct BoxRange {
  std::uint32_t node, begin, end;
};

float middle_of(float low, float high) { return 0.5F * std::max(low, -kMaxFloat) + 0.5F * std::min(high, kMaxFloat); }

/// Divides entries at about the median along the longest axis, so that the first half has a multiple of four. Precondition: more than four.
std::uint32_t divide_at_median(Entries& entries, std::uint32_t begin, std::uint32_t end) {
  std::array<float, 3> low = entries[begin].middle, high = low;
  for (std::uint32_t i = begin; i < end; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], entries[i].middle[axis]);
      high[axis] = std::max(high[axis], entries[i].middle[axis]);
    }
  std::size_t axis = 0;
  for (std::size_t other = 1; other < 3; ++other)
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  const std::uint32_t fours = (end - begin + 3) / 4;
  const std::uint32_t middle = begin + fours / 2 * 4;
  std::nth_element(entries.begin() + begin, entries.begin() + middle, entries.begin() + end, [axis](const BoxEntry& a, const BoxEntry& b) {
    return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.shell < b.shell;
  });
  return middle;
}

/// The ends of up to four ranges that a range is divided into; the last one is its own end.
struct Cuts {
  std::array<std::uint32_t, 4> end{};
  std::size_t count = 0;
};

Cuts cut_in_four(Entries& entries, std::uint32_t begin, std::uint32_t end) {
  Cuts cuts;
  const auto cut = [&](std::uint32_t from, std::uint32_t to) {
    if (to - from > 4) cuts.end[cuts.count++] = divide_at_median(entries, from, to);
    cuts.end[cuts.count++] = to;
  };
  const std::uint32_t middle = divide_at_median(entries, begin, end);
  cut(begin, middle);
  cut(middle, end);
  return cuts;
}

/// Fills a node's places from its range: with shells, or with new nodes at the end of `nodes`, whose ranges go to `open`.
void fill_node(std::vector<BoxNode>& nodes, const Entries& entries, const BoxRange& range, const Cuts& cuts, std::vector<BoxRange>& open) {
  std::size_t place = 0;
  const auto put_shell = [&](std::uint32_t i) { nodes[range.node].child[place++] = entries[i].shell | BoxNode::kShellBit; };
  if (cuts.count == 0) {
    for (std::uint32_t i = range.begin; i < range.end; ++i) put_shell(i);
    return;
  }
  std::uint32_t begin = range.begin;
  for (std::size_t c = 0; c < cuts.count; ++c) {
    if (cuts.end[c] - begin == 1) {
      put_shell(begin);
    } else {
      const auto node = static_cast<std::uint32_t>(nodes.size());
      nodes[range.node].child[place++] = node;
      nodes.emplace_back().parent = range.node;
      open.push_back({node, begin, cuts.end[c]});
    }
    begin = cuts.end[c];
  }
}

Cuts cuts_of(Entries& entries, const BoxRange& range) {
  return range.end - range.begin <= 4 ? Cuts{} : cut_in_four(entries, range.begin, range.end);
}

/// Divides a range to the end. Returns the levels below it.
std::size_t build_subtree(std::vector<BoxNode>& nodes, Entries& entries, const BoxRange& range) {
  std::size_t levels = 0;
  std::vector<BoxRange> open{range};
  while (!open.empty()) {
    ++levels;
    for (const BoxRange& each : std::exchange(open, {})) fill_node(nodes, entries, each, cuts_of(entries, each), open);
  }
  return levels;
}

}  // namespace

FloatBox BoxTree::box_of(ShellIndex shell) const {
  FloatBox box;
  each_triangle(shell, [&](const Vec3& a, const Vec3& b, const Vec3& c, bool) {
    box.add(a);
    box.add(b);
    box.add(c);
  });
  return box;
}

BoxTree::BoxTree(const Model& model) {
  take(model);
  build();
}

void BoxTree::take(const Model& model) {
  positions_ = model.positions;
  shell_nodes_ = model.shell_nodes;
}

/// Divides ranges of shells until a node is left for each four: level by level until there are many ranges, then the subtrees under them.
/// Both in parallel; the order of the nodes doesn't depend on the threads.
void BoxTree::build() {
  const std::size_t count = shell_nodes_.size();
  std::vector<FloatBox> boxes(count);
  parallel_for(count, kBoxGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) boxes[s] = box_of(ShellIndex(s));
  });
  Entries entries;
  entries.reserve(count);
  for (std::size_t s = 0; s < count; ++s)
    if (const FloatBox& box = boxes[s]; !box.empty())
      entries.push_back({{middle_of(box.low[0], box.high[0]), middle_of(box.low[1], box.high[1]), middle_of(box.low[2], box.high[2])},
                         static_cast<std::uint32_t>(s)});

  std::vector<BoxNode> nodes(1);
  std::vector<BoxRange> open{{0, 0, static_cast<std::uint32_t>(entries.size())}};
  std::size_t levels = 0;
  for (; !open.empty() && open.size() < kSubtrees; ++levels) {
    const std::vector<BoxRange> level = std::exchange(open, {});
    std::vector<Cuts> cuts(level.size());
    parallel_for(level.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) cuts[i] = cuts_of(entries, level[i]);
    });
    for (std::size_t i = 0; i < level.size(); ++i) fill_node(nodes, entries, level[i], cuts[i], open);
  }
  std::vector<std::vector<BoxNode>> below(open.size());
  std::vector<std::size_t> levels_below(open.size());
  parallel_for(open.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      below[i].resize(1);
      levels_below[i] = build_subtree(below[i], entries, {0, open[i].begin, open[i].end});
    }
  });
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto shift = static_cast<std::uint32_t>(nodes.size()) - 1;  // the subtree's root takes its parent's entry
    const auto moved = [&](std::uint32_t node) { return node == 0 ? open[i].node : node + shift; };
    for (BoxNode& node : below[i]) {
      for (std::size_t place = 0; place < 4; ++place)
        if (node.is_used(place) && node.is_node(place)) node.child[place] = moved(node.child[place]);
      node.parent = node.parent == BoxNode::kNoChild ? nodes[open[i].node].parent : moved(node.parent);
    }
    nodes[open[i].node] = below[i].front();
    nodes.insert(nodes.end(), below[i].begin() + 1, below[i].end());
    below[i] = {};
  }

  // children come after their parents: in reverse order each box is made of finished boxes
  node_of_shell_ = ChunkedArray<std::uint32_t>(count, BoxNode::kNoChild);
  for (std::size_t n = nodes.size(); n-- > 0;)
    for (std::size_t place = 0; place < 4; ++place) {
      BoxNode& node = nodes[n];
      if (!node.is_used(place)) continue;
      node.set_box(place, node.is_shell(place) ? boxes[node.shell(place).value] : nodes[node.child[place]].whole_box());
      if (node.is_shell(place)) node_of_shell_.set(node.shell(place).value, static_cast<std::uint32_t>(n));
    }
  nodes_.reset(nodes.size());
  parallel_for(nodes_.chunk_count(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const auto chunk = nodes_.put_chunk(c, std::make_shared<Nodes::Chunk>());
      std::copy_n(nodes.begin() + static_cast<std::ptrdiff_t>(c * kNodesOfChunk), chunk.size(), chunk.begin());
    }
  });
  shells_ = entries.size();
  strays_ = 0;
  depth_ = levels + (levels_below.empty() ? 0 : *std::max_element(levels_below.begin(), levels_below.end()));
}

}  // namespace prismesh::mesh::spatial
