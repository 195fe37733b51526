// One tree of boxes over all shells of a generation, brought up to date from edit to edit: for closest points, distance fields and contact.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/model/chunked_array.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/spatial/float_box.h"
#include "mesh/spatial/surface_point.h"

namespace prismesh::mesh::spatial {

/// A node of the tree: four boxes, each around one shell or one further node. An unused place has an empty box and kNoChild.
struct alignas(64) BoxNode {
  static constexpr std::uint32_t kNoChild = 0xffffffffU;
  static constexpr std::uint32_t kShellBit = 0x80000000U;

  std::array<Float4, 3> low, high;
  std::array<std::uint32_t, 4> child{kNoChild, kNoChild, kNoChild, kNoChild};  ///< with kShellBit: a shell
  std::uint32_t parent = kNoChild;                                             ///< its index is smaller than the node's

  BoxNode() {
    low.fill(Float4{kInfiniteFloat, kInfiniteFloat, kInfiniteFloat, kInfiniteFloat});
    high.fill(Float4{-kInfiniteFloat, -kInfiniteFloat, -kInfiniteFloat, -kInfiniteFloat});
  }
  bool is_used(std::size_t place) const { return child[place] != kNoChild; }
  bool is_shell(std::size_t place) const { return is_used(place) && (child[place] & kShellBit) != 0; }
  bool is_node(std::size_t place) const { return (child[place] & kShellBit) == 0; }
  ShellIndex shell(std::size_t place) const { return ShellIndex(std::size_t{child[place] & ~kShellBit}); }
  std::size_t place_of(std::uint32_t wanted) const;  ///< precondition: it is a child
  FloatBox box(std::size_t place) const;
  void set_box(std::size_t place, const FloatBox& box);
  FloatBox whole_box() const;
};
static_assert(sizeof(BoxNode) == 128);

/// A quad counts as the two triangles at its diagonal from the first corner to the third. A triangle with a corner that isn't finite is
/// left out, and so is a removed shell; a shell without area counts as what its corners span. Results are the same bits whatever the number
/// of threads, and whether the tree was built or brought up to date.
///
/// A value: a copy shares every chunk of nodes until one side changes it, so each generation can keep its tree at the edit's cost. It
/// shares the model's positions and corners, too, and so needs no model for its answers. Some 50 bytes a shell of its own.
/// Any number of threads may ask at once.
class BoxTree {
 public:
  BoxTree() = default;
  /// Builds the tree on all cores. Precondition, here and below: less than 2^31 shells.
  explicit BoxTree(const Model& model);

  /// What bringing the tree up to date took.
  struct Update {
    std::size_t moved = 0;  ///< shells whose boxes were computed again
    std::size_t added = 0;
    std::size_t removed = 0;
    bool rebuilt = false;  ///< after many additions and removals
    FloatBox changed;      ///< contains each shell that changed at all, as it was and as it is; empty: none did
  };
  /// Brings the tree up to date with another state of its model: the next one, or any other (undo). Costs what differs and the way from
  /// there to the root. The shells' places are freed and filled: a new shell goes to where boxes grow least. When more shells were added
  /// and removed than a quarter of all, the tree is built anew. Precondition: the model has its adjacency.
  Update follow(const Model& model);
  /// Leaves shells out of all answers; a later `follow` doesn't bring them back unless they change. At the cost of an edit of them.
  void leave_out(const ShellSet& shells);

  /// Returns the closest point; of equally close shells the first; nothing if none is within `max_distance` (inclusive), if the point isn't
  /// finite, or if the distance isn't >= 0. `hint` is any shell; a close one makes the search faster and changes nothing else.
  std::optional<SurfacePoint> closest(const Vec3& point, double max_distance = std::numeric_limits<double>::infinity(),
                                      ShellIndex hint = {}) const;

  /// Calls `visit(ShellIndex, const FloatBox&)` for each shell whose box is within `distance` of the box (and for some that are farther by
  /// rounding), until it returns false. The order depends on how the tree came about. Precondition: the numbers are finite, low <= high.
  template <class Visit>
  void near_box(const Vec3& low, const Vec3& high, double distance, Visit&& visit) const;

  /// Calls `visit(ShellIndex a, ShellIndex b)`, a < b, for each pair of shells whose boxes are within `distance` of each other, neighbours
  /// included (and for some that are farther by rounding). The order depends on how the tree came about.
  template <class Visit>
  void near_pairs(double distance, Visit&& visit) const;

  bool contains(ShellIndex shell) const { return shell.value < node_of_shell_.size() && node_of_shell_[shell.value] != BoxNode::kNoChild; }
  bool empty() const { return shells_ == 0; }
  std::size_t shell_count() const { return shells_; }  ///< in the tree
  std::size_t depth() const { return depth_; }         ///< at least the number of levels
  /// Bytes of the tree's own arrays, whether other trees share them or not.
  std::size_t bytes() const;
  /// Bytes that a tree made from `before` doesn't share with it.
  std::size_t bytes_beside(const BoxTree& before) const;

  const ShellNodes& corners(ShellIndex shell) const { return shell_nodes_[shell.value]; }
  const Vec3& position(NodeIndex node) const { return positions_[node.value]; }
  const ChunkedArray<Vec3>& positions() const { return positions_; }
  /// Calls `visit(corner 0, corner 1, corner 2, second)` for each finite triangle of a shell that isn't removed.
  template <class Visit>
  void each_triangle(ShellIndex shell, Visit&& visit) const;
  FloatBox box_of(ShellIndex shell) const;

 private:
  static constexpr std::size_t kNodesOfChunk = 256;
  static constexpr std::size_t kMaxDepth = 64;  ///< a tree that is deeper is built anew
  using Nodes = ChunkedArray<BoxNode, kNodesOfChunk>;
  struct Changed;

  void build();
  void take(const Model& model);
  Changed changed_shells(const Model& model) const;
  void refit(const std::vector<std::uint32_t>& changed);
  void insert(ShellIndex shell, const FloatBox& box);
  std::uint32_t add_node(std::uint32_t parent);
  template <class Visit>
  void pairs_within(std::uint32_t node, float bound, Visit&& visit) const;
  template <class Visit>
  void pairs_between(std::uint32_t a, const FloatBox& box_a, std::uint32_t b, const FloatBox& box_b, float bound, Visit&& visit) const;

  ChunkedArray<Vec3> positions_;
  ChunkedArray<ShellNodes> shell_nodes_;
  Nodes nodes_;
  ChunkedArray<std::uint32_t> node_of_shell_;  ///< kNoChild: not in the tree
  std::size_t shells_ = 0;
  std::size_t strays_ = 0;  ///< additions and removals since the tree was built
  std::size_t depth_ = 0;
};

// --- implementation ---

inline std::size_t BoxNode::place_of(std::uint32_t wanted) const {
  std::size_t place = 0;
  while (child[place] != wanted) ++place;
  return place;
}

inline FloatBox BoxNode::box(std::size_t place) const {
  FloatBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = low[axis][place];
    box.high[axis] = high[axis][place];
  }
  return box;
}

inline void BoxNode::set_box(std::size_t place, const FloatBox& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis][place] = box.low[axis];
    high[axis][place] = box.high[axis];
  }
}

inline FloatBox BoxNode::whole_box() const {
  FloatBox whole = box(0);
  for (std::size_t place = 1; place < 4; ++place) whole.add(box(place));
  return whole;
}

/// The squares of the distances of a node's four boxes from a box; infinite for an empty one.
inline Float4 distances2(const BoxNode& node, const FloatBox& from) {
  const auto max = [](const Float4& a, const Float4& b) -> Float4 { return a > b ? a : b; };
  Float4 sum{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Float4 gap = max(max(node.low[axis] - from.high[axis], from.low[axis] - node.high[axis]), Float4{});
    sum += gap * gap;
  }
  return sum;
}

template <class Visit>
void BoxTree::near_box(const Vec3& low, const Vec3& high, double distance, Visit&& visit) const {
  if (empty() || !(distance >= 0)) return;
  FloatBox from;
  from.add(low);
  from.add(high);
  const float bound = bound_of_square(distance * distance);
  std::array<std::uint32_t, 3 * kMaxDepth + 4> stack;
  std::size_t waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const BoxNode& node = nodes_[stack[--waiting]];
    const Float4 distances = distances2(node, from);
    for (std::size_t place = 0; place < 4; ++place) {
      if (!(distances[place] <= bound) || !node.is_used(place)) continue;
      if (node.is_node(place))
        stack[waiting++] = node.child[place];
      else if (!visit(node.shell(place), node.box(place)))
        return;
    }
  }
}

template <class Visit>
void BoxTree::near_pairs(double distance, Visit&& visit) const {
  if (!empty() && distance >= 0) pairs_within(0, bound_of_square(distance * distance), visit);
}

template <class Visit>
void BoxTree::pairs_within(std::uint32_t at, float bound, Visit&& visit) const {
  const BoxNode& node = nodes_[at];
  for (std::size_t a = 0; a < 4; ++a) {
    if (!node.is_used(a)) continue;
    if (node.is_node(a)) pairs_within(node.child[a], bound, visit);
    for (std::size_t b = a + 1; b < 4; ++b)
      if (node.is_used(b)) pairs_between(node.child[a], node.box(a), node.child[b], node.box(b), bound, visit);
  }
}

template <class Visit>
void BoxTree::pairs_between(std::uint32_t a, const FloatBox& box_a, std::uint32_t b, const FloatBox& box_b, float bound,
                            Visit&& visit) const {
  if (!(distance2(box_a, box_b) <= bound)) return;
  const bool shell_a = (a & BoxNode::kShellBit) != 0, shell_b = (b & BoxNode::kShellBit) != 0;
  if (shell_a && shell_b) {
    const ShellIndex first(std::size_t{a & ~BoxNode::kShellBit}), second(std::size_t{b & ~BoxNode::kShellBit});
    visit(std::min(first, second), std::max(first, second));
    return;
  }
  const auto extent = [](const FloatBox& box) {
    return std::max({box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
  };
  const bool open_a = !shell_a && (shell_b || extent(box_a) >= extent(box_b));
  const BoxNode& opened = nodes_[open_a ? a : b];
  for (std::size_t place = 0; place < 4; ++place) {
    if (!opened.is_used(place)) continue;
    if (open_a)
      pairs_between(opened.child[place], opened.box(place), b, box_b, bound, visit);
    else
      pairs_between(a, box_a, opened.child[place], opened.box(place), bound, visit);
  }
}

/// As Eigen's allFinite, but without a branch for each coordinate.
inline bool is_finite(const Vec3& p) { return p.x() * 0 + p.y() * 0 + p.z() * 0 == 0; }

template <class Visit>
void BoxTree::each_triangle(ShellIndex shell, Visit&& visit) const {
  const ShellNodes& nodes = shell_nodes_[shell.value];
  if (!nodes.node[0].valid()) return;
  const Vec3& a = position(nodes.node[0]);
  const Vec3& c = position(nodes.node[2]);
  if (!is_finite(a) || !is_finite(c)) return;
  if (const Vec3& b = position(nodes.node[1]); is_finite(b)) visit(a, b, c, false);
  if (nodes.is_triangle()) return;
  if (const Vec3& d = position(nodes.node[3]); is_finite(d)) visit(a, c, d, true);
}

}  // namespace prismesh::mesh::spatial
