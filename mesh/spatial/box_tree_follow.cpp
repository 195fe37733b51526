#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "base/parallel_for.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::size_t kFollowGrain = 2048;
constexpr std::size_t kMinStrays = 256;  ///< so few additions and removals don't make a tree bad, however small it is

/// Numbers that are marked, and taken in ascending or descending order.
class Marks {
 public:
  explicit Marks(std::size_t size) : words_((size + 63) / 64) {}
  void set(std::size_t i) { words_[i / 64] |= std::uint64_t{1} << (i % 64); }

  std::vector<ShellIndex> ascending() const {
    std::vector<ShellIndex> marked;
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t word = words_[w]; word != 0; word &= word - 1)
        marked.emplace_back(w * 64 + static_cast<std::size_t>(std::countr_zero(word)));
    return marked;
  }
  /// Also what `visit` marks meanwhile, as long as it is below what is visited.
  template <class Visit>
  void descending(Visit&& visit) {
    for (std::size_t w = words_.size(); w-- > 0;)
      while (words_[w] != 0) {
        const auto bit = static_cast<std::size_t>(63 - std::countl_zero(words_[w]));
        words_[w] &= ~(std::uint64_t{1} << bit);
        visit(w * 64 + bit);
      }
  }

 private:
  std::vector<std::uint64_t> words_;
};

/// Calls `visit(i)` for each entry of both arrays that differs bit by bit. Shared chunks cost nothing.
template <class T, class Visit>
void each_difference(const ChunkedArray<T>& a, const ChunkedArray<T>& b, Visit&& visit) {
  for (std::size_t c = 0; c < std::min(a.chunk_count(), b.chunk_count()); ++c) {
    if (a.chunk_owner(c) == b.chunk_owner(c)) continue;
    const std::span<const T> of_a = a.chunk(c), of_b = b.chunk(c);
    for (std::size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i)
      if (std::memcmp(&of_a[i], &of_b[i], sizeof(T)) != 0) visit(c * kChunkSize + i);
  }
}

/// Half the area of the box around two boxes, less that of the first.
double growth(const FloatBox& box, const FloatBox& added) {
  const auto half_area = [](const FloatBox& of) {
    const double x = double{of.high[0]} - of.low[0], y = double{of.high[1]} - of.low[1], z = double{of.high[2]} - of.low[2];
    return x * y + y * z + z * x;
  };
  if (box.empty()) return half_area(added);
  FloatBox both = box;
  both.add(added);
  return half_area(both) - half_area(box);
}

}  // namespace

/// Shells whose boxes may differ, ascending, with their boxes in the new state.
struct BoxTree::Changed {
  ShellSet shells;
  std::vector<FloatBox> boxes;
};

/// Precondition: `model` isn't taken yet.
BoxTree::Changed BoxTree::changed_shells(const Model& model) const {
  const std::size_t before = shell_nodes_.size(), after = model.shell_nodes.size();
  Marks marks(std::max(before, after));
  each_difference(positions_, model.positions, [&](std::size_t node) {
    for (const ShellIndex shell : model.adjacency->shells_of(NodeIndex(node))) marks.set(shell.value);
  });
  each_difference(shell_nodes_, model.shell_nodes, [&](std::size_t shell) { marks.set(shell); });
  for (std::size_t s = std::min(before, after); s < std::max(before, after); ++s) marks.set(s);
  return {marks.ascending(), {}};
}

BoxTree::Update BoxTree::follow(const Model& model) {
  Changed changed = changed_shells(model);
  const std::size_t count = model.shell_nodes.size();
  take(model);
  Update update;
  if (nodes_.empty()) {
    build();
    if (shells_ == 0) return update;
    return {0, shells_, 0, true, nodes_[0].whole_box()};
  }
  changed.boxes.resize(changed.shells.size());
  parallel_for(changed.shells.size(), kFollowGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (changed.shells[i].value < count) changed.boxes[i] = box_of(changed.shells[i]);
  });

  std::vector<std::uint32_t> dirty;
  if (count > node_of_shell_.size()) node_of_shell_.resize(count, BoxNode::kNoChild);
  std::vector<std::size_t> added;
  for (std::size_t i = 0; i < changed.shells.size(); ++i) {
    const ShellIndex shell = changed.shells[i];
    const FloatBox& box = changed.boxes[i];
    update.changed.add(box);
    const std::uint32_t at = node_of_shell_[shell.value];
    if (at == BoxNode::kNoChild) {
      if (!box.empty()) added.push_back(i);
      continue;
    }
    const std::size_t place = nodes_[at].place_of(shell.value | BoxNode::kShellBit);
    update.changed.add(nodes_[at].box(place));
    if (nodes_[at].box(place) == box) continue;
    BoxNode& node = nodes_.own_chunk(at / kNodesOfChunk)[at % kNodesOfChunk];
    node.set_box(place, box);
    dirty.push_back(at);
    if (!box.empty()) {
      ++update.moved;
      continue;
    }
    node.child[place] = BoxNode::kNoChild;
    node_of_shell_.set(shell.value, BoxNode::kNoChild);
    ++update.removed;
  }
  if (count < node_of_shell_.size()) node_of_shell_.resize(count, BoxNode::kNoChild);
  shells_ -= update.removed;
  strays_ += update.removed;
  update.added = added.size();
  if (strays_ + added.size() > std::max(kMinStrays, shells_ / 4)) {
    build();
    update.rebuilt = true;
    return update;
  }
  refit(dirty);
  for (const std::size_t i : added) insert(changed.shells[i], changed.boxes[i]);
  if (depth_ > kMaxDepth) {
    build();
    update.rebuilt = true;
  }
  return update;
}

/// Makes the boxes above changed nodes anew, from the last node to the first: children have larger numbers than their parents.
void BoxTree::refit(const std::vector<std::uint32_t>& changed) {
  Marks dirty(nodes_.size());
  for (const std::uint32_t node : changed) dirty.set(node);
  dirty.descending([&](std::size_t at) {
    const BoxNode& node = nodes_[at];
    if (node.parent == BoxNode::kNoChild) return;
    const FloatBox box = node.whole_box();
    const BoxNode& parent = nodes_[node.parent];
    const std::size_t place = parent.place_of(static_cast<std::uint32_t>(at));
    if (parent.box(place) == box) return;
    dirty.set(node.parent);
    nodes_.own_chunk(node.parent / kNodesOfChunk)[node.parent % kNodesOfChunk].set_box(place, box);
  });
}

void BoxTree::leave_out(const ShellSet& shells) {
  std::vector<std::uint32_t> dirty;
  for (const ShellIndex shell : shells) {
    if (!contains(shell)) continue;
    const std::uint32_t at = node_of_shell_[shell.value];
    BoxNode& node = nodes_.own_chunk(at / kNodesOfChunk)[at % kNodesOfChunk];
    const std::size_t place = node.place_of(shell.value | BoxNode::kShellBit);
    node.set_box(place, FloatBox());
    node.child[place] = BoxNode::kNoChild;
    node_of_shell_.set(shell.value, BoxNode::kNoChild);
    dirty.push_back(at);
    --shells_;
    ++strays_;
  }
  refit(dirty);
}

std::uint32_t BoxTree::add_node(std::uint32_t parent) {
  const std::size_t node = nodes_.size();
  BoxNode fresh;
  fresh.parent = parent;
  nodes_.resize(node + 1, fresh);
  return static_cast<std::uint32_t>(node);
}

/// Goes down to where boxes grow least, and puts the shell into a free place there, or into a new node together with the shell whose box
/// grows least.
void BoxTree::insert(ShellIndex shell, const FloatBox& box) {
  ++shells_;
  ++strays_;
  std::uint32_t at = 0;
  for (std::size_t level = 1;; ++level) {
    depth_ = std::max(depth_, level);
    BoxNode& node = nodes_.own_chunk(at / kNodesOfChunk)[at % kNodesOfChunk];
    std::size_t best = 4, free = 4;
    double best_growth = 0;
    for (std::size_t place = 0; place < 4; ++place) {
      if (!node.is_used(place)) {
        if (free == 4) free = place;
        continue;
      }
      const double grows = growth(node.box(place), box);
      if (best < 4 && !(grows < best_growth)) continue;
      best = place;
      best_growth = grows;
    }
    if (free < 4 && (best == 4 || node.is_shell(best))) {
      node.child[free] = shell.value | BoxNode::kShellBit;
      node.set_box(free, box);
      node_of_shell_.set(shell.value, at);
      return;
    }
    FloatBox grown = node.box(best);
    const std::uint32_t child = node.child[best];
    const FloatBox old = grown;
    grown.add(box);
    node.set_box(best, grown);
    if (node.is_node(best)) {
      at = child;
      continue;
    }
    const std::uint32_t made = add_node(at);  // may move what `node` refers to
    BoxNode& above = nodes_.own_chunk(at / kNodesOfChunk)[at % kNodesOfChunk];
    above.child[best] = made;
    BoxNode& below = nodes_.own_chunk(made / kNodesOfChunk)[made % kNodesOfChunk];
    below.child[0] = child;
    below.set_box(0, old);
    below.child[1] = shell.value | BoxNode::kShellBit;
    below.set_box(1, box);
    node_of_shell_.set(child & ~BoxNode::kShellBit, made);
    node_of_shell_.set(shell.value, made);
    depth_ = std::max(depth_, level + 1);
    return;
  }
}

}  // namespace prismesh::mesh::spatial
