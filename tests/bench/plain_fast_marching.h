// Fast marching as in the paper, to compare with: one front, plane in each triangle, each quad cut along one diagonal.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "mesh/spatial/patch.h"

namespace prismesh::mesh::bench {

/// The distance at the tip of a triangle whose front is plane, from those at the ends of its base [Kimmel 1998]; infinity if the front
/// doesn't come through the base. `a_tip` and `b_tip` are the lengths of its sides.
inline double plane_front(double at_a, double at_b, double base, double a_tip, double b_tip) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double slope_x = (at_b - at_a) / base;
  if (!(std::abs(slope_x) < 1)) return kNone;
  const double x = (a_tip * a_tip + base * base - b_tip * b_tip) / (2 * base);
  const double y = std::sqrt(std::max(0.0, a_tip * a_tip - x * x));
  const double slope_y = std::sqrt(1 - slope_x * slope_x);
  const double crossing = x * slope_y - y * slope_x;
  if (crossing < 0 || crossing > base * slope_y) return kNone;
  return at_a + x * slope_x + y * slope_y;
}

/// Distances from one node over a patch of quads. Obtuse corners aren't unfolded, so it errs there.
inline std::vector<double> plain_fast_marching(const spatial::Patch& patch, std::uint32_t source) {
  std::vector<double> distance(patch.nodes.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint8_t> done(patch.nodes.size(), 0);
  using Reached = std::pair<double, std::uint32_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  const auto offer = [&](std::uint32_t node, double to) {
    if (!(to < distance[node])) return;
    distance[node] = to;
    front.emplace(to, node);
  };
  const auto cross = [&](std::uint32_t node, double to_a, std::uint32_t a, double to_b, std::uint32_t b, double a_to_b) {
    if (done[a] == 0) offer(a, distance[node] + to_a);
    if (done[b] == 0) offer(b, distance[node] + to_b);
    if (done[a] != 0 && done[b] == 0) offer(b, plane_front(distance[node], distance[a], to_a, to_b, a_to_b));
    if (done[b] != 0 && done[a] == 0) offer(a, plane_front(distance[node], distance[b], to_b, to_a, a_to_b));
  };
  offer(source, 0);
  while (!front.empty()) {
    const std::uint32_t node = front.top().second;
    front.pop();
    if (done[node] != 0) continue;
    done[node] = 1;
    for (std::uint32_t k = patch.node_first[node]; k < patch.node_first[node + 1]; ++k) {
      const auto& corner = patch.shells[patch.node_shells[k]];
      const auto& side = patch.lengths[patch.node_shells[k]];  // 01 12 23 30 02 13
      if (corner[0] == node) {
        cross(node, side[0], corner[1], side[4], corner[2], side[1]);
        cross(node, side[4], corner[2], side[3], corner[3], side[2]);
      } else if (corner[2] == node) {
        cross(node, side[4], corner[0], side[1], corner[1], side[0]);
        cross(node, side[4], corner[0], side[2], corner[3], side[3]);
      } else if (corner[1] == node) {
        cross(node, side[0], corner[0], side[1], corner[2], side[4]);
      } else {
        cross(node, side[3], corner[0], side[2], corner[2], side[4]);
      }
    }
  }
  return distance;
}

}  // namespace prismesh::mesh::bench
