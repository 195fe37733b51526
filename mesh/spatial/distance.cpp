#include "mesh/spatial/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace prismesh::mesh::spatial {

namespace {

using Box = Eigen::AlignedBox3d;

/// A node or half a shell.
struct Primitive {
  Triangle corner;
  NodeIndex node;
  ShellIndex shell;

  Box box() const {
    Box box(corner[0]);
    box.extend(corner[1]);
    box.extend(corner[2]);
    return box;
  }
};

std::vector<Primitive> primitives_of(const Model& model, const Shape& shape) {
  std::vector<Primitive> primitives;
  primitives.reserve(shape.nodes.size() + 2 * shape.shells.size());
  for (const NodeIndex node : shape.nodes) {
    const Vec3& p = model.position(node);
    primitives.push_back({Triangle{p, p, p}, node, {}});
  }
  for (const ShellIndex shell : shape.shells) {
    const ShellNodes& nodes = model.shell(shell);
    const auto corner = [&](int i) -> const Vec3& { return model.position(nodes.node[i]); };
    primitives.push_back({Triangle{corner(0), corner(1), corner(2)}, {}, shell});
    if (!nodes.is_triangle()) primitives.push_back({Triangle{corner(0), corner(2), corner(3)}, {}, shell});
  }
  return primitives;
}

/// A binary tree of boxes around groups of primitives; a group is a range of `primitives`.
class Tree {
 public:
  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0;
    std::uint32_t left = 0, right = 0;  ///< 0: a leaf (0 is the root, which is no child)
    bool is_leaf() const { return left == 0; }
  };

  explicit Tree(std::vector<Primitive> all) : primitives(std::move(all)) {
    nodes.reserve(primitives.size());
    build(0, static_cast<std::uint32_t>(primitives.size()));
  }

  std::vector<Primitive> primitives;
  std::vector<Node> nodes;

 private:
  static constexpr std::uint32_t kLeafSize = 4;

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back({Box(), begin, end});
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(primitives[i].box());
    nodes[index].box = box;
    if (end - begin <= kLeafSize) return index;
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const auto middle = begin + (end - begin) / 2;
    const auto centre = [axis](const Primitive& p) { return p.corner[0][axis] + p.corner[1][axis] + p.corner[2][axis]; };
    std::nth_element(primitives.begin() + begin, primitives.begin() + middle, primitives.begin() + end,
                     [&](const Primitive& p, const Primitive& q) { return centre(p) < centre(q); });
    const std::uint32_t left = build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes[index].left = left;
    nodes[index].right = right;
    return index;
  }
};

/// Traverses both trees at once, the nearer pair of boxes first. Skips pairs that can't be closer than the best so far.
class Search {
 public:
  Search(const Tree& a, const Tree& b) : a_(a), b_(b) { visit(0, 0); }

  Nearest best{std::numeric_limits<double>::infinity()};
  const Primitive* of_a = nullptr;
  const Primitive* of_b = nullptr;

 private:
  double apart(std::uint32_t a, std::uint32_t b) const { return a_.nodes[a].box.squaredExteriorDistance(b_.nodes[b].box); }

  void visit(std::uint32_t at_a, std::uint32_t at_b) {
    if (best.distance2 == 0 || apart(at_a, at_b) >= best.distance2) return;
    const Tree::Node& a = a_.nodes[at_a];
    const Tree::Node& b = b_.nodes[at_b];
    if (a.is_leaf() && b.is_leaf()) return compare(a, b);
    const bool open_a = !a.is_leaf() && (b.is_leaf() || a.box.diagonal().squaredNorm() >= b.box.diagonal().squaredNorm());
    std::pair<std::uint32_t, std::uint32_t> first = open_a ? std::pair(a.left, at_b) : std::pair(at_a, b.left);
    std::pair<std::uint32_t, std::uint32_t> second = open_a ? std::pair(a.right, at_b) : std::pair(at_a, b.right);
    if (apart(second.first, second.second) < apart(first.first, first.second)) std::swap(first, second);
    visit(first.first, first.second);
    visit(second.first, second.second);
  }

  void compare(const Tree::Node& a, const Tree::Node& b) {
    for (std::uint32_t i = a.begin; i < a.end; ++i)
      for (std::uint32_t j = b.begin; j < b.end; ++j) {
        const Nearest nearest = nearest_of_triangles(a_.primitives[i].corner, b_.primitives[j].corner);
        if (!(nearest.distance2 < best.distance2)) continue;
        best = nearest;
        of_a = &a_.primitives[i];
        of_b = &b_.primitives[j];
      }
  }

  const Tree& a_;
  const Tree& b_;
};

}  // namespace

std::optional<Closest> shortest_distance(const Model& model, const Shape& a, const Shape& b) {
  const Tree tree_a(primitives_of(model, a));
  const Tree tree_b(primitives_of(model, b));
  if (tree_a.primitives.empty() || tree_b.primitives.empty()) return std::nullopt;
  const Search search(tree_a, tree_b);
  if (search.of_a == nullptr) return std::nullopt;  // no finite coordinates
  Closest closest;
  closest.distance = std::sqrt(search.best.distance2);
  closest.a = {search.best.on_a, search.of_a->node, search.of_a->shell};
  closest.b = {search.best.on_b, search.of_b->node, search.of_b->shell};
  return closest;
}

}  // namespace prismesh::mesh::spatial
