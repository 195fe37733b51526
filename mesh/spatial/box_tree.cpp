#include "mesh/spatial/box_tree.h"

#include <algorithm>
#include <cmath>

#include "mesh/spatial/point_triangle.h"

namespace prismesh::mesh::spatial {

namespace {

struct WaitingNode {
  std::uint32_t node;
  float distance2;
};

}  // namespace

std::optional<SurfacePoint> BoxTree::closest(const Vec3& point, double max_distance, ShellIndex hint) const {
  if (empty() || !point.allFinite() || !(max_distance >= 0)) return std::nullopt;
  FloatBox from;
  from.add(point);
  OnTriangle best{};
  ShellIndex best_shell;
  bool best_second = false;
  best.distance2 = max_distance * max_distance * (1 + 1e-15);  // so that a distance is within itself in spite of rounding
  float bound = bound_of_square(best.distance2);
  const auto ask = [&](ShellIndex shell) {
    each_triangle(shell, [&](const Vec3& a, const Vec3& b, const Vec3& c, bool second) {
      if (below_distance2(a, b, c, point) > best.distance2) return;
      const OnTriangle on = closest_on_triangle({a, b, c}, point);
      const bool nearer = on.distance2 < best.distance2 || (on.distance2 == best.distance2 && (!best_shell.valid() || shell < best_shell));
      if (!nearer) return;
      best = on;
      best_shell = shell;
      best_second = second;
      bound = bound_of_square(best.distance2);
    });
  };
  if (contains(hint)) ask(hint);

  std::array<WaitingNode, 3 * kMaxDepth + 4> stack;
  std::size_t waiting = 0;
  stack[waiting++] = {0, 0};
  while (waiting > 0) {
    const WaitingNode next = stack[--waiting];
    if (!(next.distance2 <= bound)) continue;
    const BoxNode& node = nodes_[next.node];
    const Float4 distances = distances2(node, from);
    // the places within the bound, ascending by distance
    std::array<std::size_t, 4> order;
    std::size_t count = 0;
    for (std::size_t place = 0; place < 4; ++place) {
      if (!(distances[place] <= bound) || !node.is_used(place)) continue;
      std::size_t at = count++;
      for (; at > 0 && distances[order[at - 1]] > distances[place]; --at) order[at] = order[at - 1];
      order[at] = place;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (node.is_shell(order[i]) && distances[order[i]] <= bound && node.shell(order[i]) != hint) ask(node.shell(order[i]));
    for (std::size_t i = count; i-- > 0;)
      if (node.is_node(order[i])) stack[waiting++] = {node.child[order[i]], distances[order[i]]};
  }
  if (!best_shell.valid()) return std::nullopt;
  SurfacePoint found{best_shell, best.point, std::sqrt(best.distance2), {}};
  found.share[0] = best.share[0];
  found.share[best_second ? 2 : 1] = best.share[1];
  found.share[best_second ? 3 : 2] = best.share[2];
  return found;
}

std::size_t BoxTree::bytes() const {
  return nodes_.chunk_count() * (sizeof(Nodes::Chunk) + sizeof(std::shared_ptr<Nodes::Chunk>)) +
         node_of_shell_.chunk_count() * (sizeof(ChunkedArray<std::uint32_t>::Chunk) + sizeof(std::shared_ptr<void>));
}

std::size_t BoxTree::bytes_beside(const BoxTree& before) const {
  std::size_t bytes = 0;
  for (std::size_t c = 0; c < nodes_.chunk_count(); ++c)
    if (c >= before.nodes_.chunk_count() || nodes_.chunk_owner(c) != before.nodes_.chunk_owner(c)) bytes += sizeof(Nodes::Chunk);
  for (std::size_t c = 0; c < node_of_shell_.chunk_count(); ++c)
    if (c >= before.node_of_shell_.chunk_count() || node_of_shell_.chunk_owner(c) != before.node_of_shell_.chunk_owner(c))
      bytes += sizeof(ChunkedArray<std::uint32_t>::Chunk);
  return bytes;
}

}  // namespace prismesh::mesh::spatial
