#include "mesh/spatial/geodesic.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mesh/spatial/unfold.h"

namespace prismesh::mesh::spatial {

namespace {

constexpr std::uint32_t kNowhere = 0xffffffffu;
constexpr double kMinGain = 1e-9;           ///< share of its distance that a finished node must gain to be queued again
constexpr std::uint8_t kMaxRequeues = 200;  ///< of one node; bounds the work, far above what meshes need

/// What is known of a node. One struct, because marching asks for all of it at once, in an order that the cache doesn't know.
struct NodeState {
  double distance = kUnreached;
  std::uint32_t centre = kNowhere;  ///< node that the wave spreads from in circles: a source, or the last turn of the path
  std::uint32_t source = kNowhere;
  std::uint32_t place = kNowhere;  ///< in the heap
  bool done = false;
  std::uint8_t requeues = 0;  ///< how often the node was queued again
};

/// A heap of nodes by distance, the nearest on top; of equals the lower number, so that the order never depends on history. An entry
/// carries its distance, so that comparing needs no look at the nodes.
class NearestFirst {
 public:
  explicit NearestFirst(std::vector<NodeState>& states) : states_(states) {}

  bool empty() const { return heap_.empty(); }

  /// Adds a node, or moves it up after its distance decreased.
  void raise(std::uint32_t node) {
    NodeState& state = states_[node];
    std::size_t at = state.place;
    if (at == kNowhere) {
      at = heap_.size();
      heap_.emplace_back();
    }
    const Entry entry{state.distance, node};
    while (at > 0) {
      const std::size_t parent = (at - 1) / 2;
      if (!before(entry, heap_[parent])) break;
      settle(heap_[parent], at);
      at = parent;
    }
    settle(entry, at);
  }

  std::uint32_t pop() {
    const std::uint32_t top = heap_.front().node;
    const Entry last = heap_.back();
    heap_.pop_back();
    states_[top].place = kNowhere;
    if (!heap_.empty()) sink(last);
    return top;
  }

 private:
  struct Entry {
    double distance = 0;
    std::uint32_t node = 0;
  };

  static bool before(const Entry& a, const Entry& b) { return a.distance < b.distance || (a.distance == b.distance && a.node < b.node); }
  void settle(const Entry& entry, std::size_t at) {
    heap_[at] = entry;
    states_[entry.node].place = static_cast<std::uint32_t>(at);
  }
  void sink(const Entry& entry) {
    std::size_t at = 0;
    for (std::size_t child = 1; child < heap_.size(); child = 2 * at + 1) {
      if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
      if (!before(heap_[child], entry)) break;
      settle(heap_[child], at);
      at = child;
    }
    settle(entry, at);
  }

  std::vector<NodeState>& states_;
  std::vector<Entry> heap_;
};

class March {
 public:
  explicit March(const Patch& patch) : patch_(patch), states_(patch.nodes.size()), queue_(states_) {}

  /// `start`: the distance of each source; empty: 0.
  std::vector<double> run(std::span<const std::uint32_t> sources, std::span<const double> start, double radius) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const std::uint32_t source = sources[i];
      if (source >= states_.size() || states_[source].centre != kNowhere) continue;
      states_[source].distance = start.empty() ? 0 : start[i];
      states_[source].centre = states_[source].source = source;
      queue_.raise(source);
    }
    while (!queue_.empty()) {
      const std::uint32_t node = queue_.pop();
      if (states_[node].distance > radius) break;
      states_[node].done = true;
      spread_from(node);
    }
    std::vector<double> distance(states_.size());
    for (std::size_t i = 0; i < distance.size(); ++i) distance[i] = states_[i].done ? states_[i].distance : kUnreached;
    return distance;
  }

 private:
  /// A triangle that distance crosses: from its base, between the nodes a and b, to its tip.
  struct Triangle {
    std::uint32_t a;
    std::uint32_t b;
    std::uint32_t tip;
    double base;
    double a_tip;
    double b_tip;
  };
  /// The tip in the triangle's plane: the base lies on the x axis from a at 0 to b at Triangle::base, the tip above it.
  struct FlatTip {
    double x;
    double y;
  };
  /// A wave that spreads in circles from a centre, and its radii at the ends of a base.
  struct Wave {
    std::uint32_t centre;
    double radius_a;
    double radius_b;
  };

  void spread_from(std::uint32_t node) {
    for (std::uint32_t k = patch_.node_first[node]; k < patch_.node_first[node + 1]; ++k) {
      const std::uint32_t shell = patch_.node_shells[k];
      const auto& corner = patch_.shells[shell];
      if (corner[3] != corner[2])
        spread_over_quad(node, corner, patch_.lengths[shell]);
      else if (corner[2] != corner[1])
        spread_over_triangle(node, corner, patch_.lengths[shell]);
      else
        go_straight(node, corner[0] == node ? corner[1] : corner[0], patch_.lengths[shell][0]);
    }
    for (std::uint32_t k = patch_.unfolded_first[node]; k < patch_.unfolded_first[node + 1]; ++k) {
      const UnfoldedTriangle& t = patch_.unfolded[patch_.unfolded_of[k]];
      cross({t.support[0], t.support[1], t.target, t.base, t.side[0], t.side[1]});
      go_straight(node, t.target, t.side[t.support[0] == node ? 0 : 1]);
    }
  }

  /// Each corner is reached over the two triangles at its own diagonal, so both ways to split the quad count.
  void spread_over_quad(std::uint32_t node, const std::array<std::uint32_t, 4>& corner, const std::array<double, 6>& length) {
    std::size_t k = 0;
    while (corner[k] != node) ++k;
    const std::uint32_t next = corner[(k + 1) % 4];
    const std::uint32_t opposite = corner[(k + 2) % 4];
    const std::uint32_t previous = corner[(k + 3) % 4];
    const double to_next = length[k];
    const double next_to_opposite = length[(k + 1) % 4];
    const double opposite_to_previous = length[(k + 2) % 4];
    const double to_previous = length[(k + 3) % 4];
    const double to_opposite = length[4 + k % 2];
    const double next_to_previous = length[5 - k % 2];
    go_straight(node, next, to_next);
    go_straight(node, previous, to_previous);
    go_straight(node, opposite, to_opposite);
    cross({node, previous, next, to_previous, to_next, next_to_previous});
    cross({node, next, previous, to_next, to_previous, next_to_previous});
    cross({node, previous, opposite, to_previous, to_opposite, opposite_to_previous});
    cross({node, next, opposite, to_next, to_opposite, next_to_opposite});
  }

  void spread_over_triangle(std::uint32_t node, const std::array<std::uint32_t, 4>& corner, const std::array<double, 6>& length) {
    const std::array<double, 3> side{length[0], length[1], length[4]};  // 01 12 20
    std::size_t k = 0;
    while (corner[k] != node) ++k;
    const std::uint32_t next = corner[(k + 1) % 3];
    const std::uint32_t previous = corner[(k + 2) % 3];
    const double to_next = side[k];
    const double next_to_previous = side[(k + 1) % 3];
    const double to_previous = side[(k + 2) % 3];
    go_straight(node, next, to_next);
    go_straight(node, previous, to_previous);
    cross({node, previous, next, to_previous, to_next, next_to_previous});
    cross({node, next, previous, to_next, to_previous, next_to_previous});
  }

  void go_straight(std::uint32_t from, std::uint32_t to, double length) {
    offer(to, states_[from].distance + length, patch_.bends[from] != 0 ? from : states_[from].centre, states_[from].source);
  }

  void cross(const Triangle& t) {
    if (!states_[t.a].done || !states_[t.b].done || !(t.base > 0)) return;
    if (states_[t.tip].done && states_[t.tip].distance <= std::min(states_[t.a].distance, states_[t.b].distance)) return;
    const double x = (t.a_tip * t.a_tip + t.base * t.base - t.b_tip * t.b_tip) / (2 * t.base);
    const FlatTip tip{x, std::sqrt(std::max(0.0, t.a_tip * t.a_tip - x * x))};
    const std::uint32_t centre = states_[t.a].centre;
    if (centre == states_[t.b].centre)
      cross_from_centre(t, tip,
                        {centre, states_[t.a].distance - states_[centre].distance, states_[t.b].distance - states_[centre].distance});
    else
      cross_between_waves(t, tip);
  }

  /// Reaches the tip from the wave's centre, which lies below the base, at the wave's radii from its ends. False if the straight line from
  /// the centre to the tip doesn't cross the base; it then crosses another triangle.
  bool cross_from_centre(const Triangle& t, const FlatTip& tip, const Wave& wave) {
    const double centre_x = (wave.radius_a * wave.radius_a - wave.radius_b * wave.radius_b + t.base * t.base) / (2 * t.base);
    const double depth2 = wave.radius_a * wave.radius_a - centre_x * centre_x;
    if (depth2 < 0) return false;  // the wave runs along the base: go_straight covers it
    const double depth = std::sqrt(depth2);
    const double crossing = centre_x * tip.y + tip.x * depth;
    if (crossing < 0 || crossing > t.base * (depth + tip.y)) return false;
    const double dx = tip.x - centre_x;
    const double dy = tip.y + depth;
    const double distance = states_[wave.centre].distance + std::sqrt(dx * dx + dy * dy);
    // no path along the surface is shorter than the straight line
    if (distance < states_[t.tip].distance)
      offer(t.tip, std::max(distance, straight(wave.centre, t.tip)), wave.centre, states_[t.a].source);
    return true;
  }

  /// Distance at a node by the straight line in space from a centre: a lower bound.
  double straight(std::uint32_t centre, std::uint32_t node) const {
    return states_[centre].distance + (patch_.positions[node] - patch_.positions[centre]).norm();
  }

  /// Between waves of different sources the front counts as straight. Waves of one source with different centres meet behind a turn: the
  /// path to one end of the base passed the turn, the path to the other end, which the earlier centre still sees, didn't.
  void cross_between_waves(const Triangle& t, const FlatTip& tip) {
    const double slope_x = (states_[t.b].distance - states_[t.a].distance) / t.base;
    if (!(std::abs(slope_x) < 1)) return;
    const double slope_y = std::sqrt(1 - slope_x * slope_x);
    const double crossing = tip.x * slope_y - tip.y * slope_x;
    const std::uint32_t nearer = crossing < 0.5 * t.base * slope_y ? t.a : t.b;
    if (states_[t.a].source == states_[t.b].source && cross_behind_turn(t, tip)) return;
    if (crossing < 0 || crossing > t.base * slope_y) return;
    offer(t.tip, states_[t.a].distance + tip.x * slope_x + tip.y * slope_y, states_[nearer].centre, states_[nearer].source);
  }

  /// Tries the waves of both centres. At an end that a centre doesn't see, the radius of its wave is at least the distance found there, and
  /// at least the straight line in space.
  bool cross_behind_turn(const Triangle& t, const FlatTip& tip) {
    const auto over = [&](std::uint32_t centre) {
      return cross_from_centre(t, tip,
                               {centre, std::max(states_[t.a].distance, straight(centre, t.a)) - states_[centre].distance,
                                std::max(states_[t.b].distance, straight(centre, t.b)) - states_[centre].distance});
    };
    const bool from_a = over(states_[t.a].centre);
    const bool from_b = over(states_[t.b].centre);
    return from_a || from_b;
  }

  /// Lowers a node's distance. A finished node is queued again if its distance gets lower: where corners are obtuse or the source is near,
  /// the ends of a base may be finished after the tip.
  void offer(std::uint32_t node, double distance, std::uint32_t centre, std::uint32_t source) {
    NodeState& state = states_[node];
    if (state.done) {
      if (!(distance < state.distance * (1 - kMinGain)) || state.requeues == kMaxRequeues) return;
      ++state.requeues;
    } else if (!(distance < state.distance)) {
      return;
    }
    state.done = false;
    state.distance = distance;
    state.centre = centre;
    state.source = source;
    queue_.raise(node);
  }

  const Patch& patch_;
  std::vector<NodeState> states_;
  NearestFirst queue_;
};

}  // namespace

std::vector<double> geodesic_distance(const Patch& patch, std::span<const std::uint32_t> sources, double radius) {
  return March(patch).run(sources, {}, radius);
}

std::vector<double> geodesic_distance_from(const Patch& patch, std::span<const std::uint32_t> sources, std::span<const double> start) {
  return March(patch).run(sources, start, kUnreached);
}

}  // namespace prismesh::mesh::spatial
