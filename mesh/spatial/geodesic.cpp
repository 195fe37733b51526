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

/// A heap of nodes by distance, the nearest on top; of equals the lower number, so that the order never depends on history.
class NearestFirst {
 public:
  explicit NearestFirst(const std::vector<double>& distance) : distance_(distance), place_(distance.size(), kNowhere) {}

  bool empty() const { return heap_.empty(); }

  /// Adds a node, or moves it up after its distance decreased.
  void raise(std::uint32_t node) {
    if (place_[node] == kNowhere) {
      place_[node] = static_cast<std::uint32_t>(heap_.size());
      heap_.push_back(node);
    }
    std::size_t at = place_[node];
    while (at > 0) {
      const std::size_t parent = (at - 1) / 2;
      if (!before(node, heap_[parent])) break;
      settle(heap_[parent], at);
      at = parent;
    }
    settle(node, at);
  }

  std::uint32_t pop() {
    const std::uint32_t top = heap_.front();
    const std::uint32_t last = heap_.back();
    heap_.pop_back();
    place_[top] = kNowhere;
    if (!heap_.empty()) sink(last);
    return top;
  }

 private:
  bool before(std::uint32_t a, std::uint32_t b) const { return distance_[a] < distance_[b] || (distance_[a] == distance_[b] && a < b); }
  void settle(std::uint32_t node, std::size_t at) {
    heap_[at] = node;
    place_[node] = static_cast<std::uint32_t>(at);
  }
  void sink(std::uint32_t node) {
    std::size_t at = 0;
    for (std::size_t child = 1; child < heap_.size(); child = 2 * at + 1) {
      if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
      if (!before(heap_[child], node)) break;
      settle(heap_[child], at);
      at = child;
    }
    settle(node, at);
  }

  const std::vector<double>& distance_;
  std::vector<std::uint32_t> heap_;
  std::vector<std::uint32_t> place_;
};

class March {
 public:
  explicit March(const Patch& patch)
      : patch_(patch),
        distance_(patch.nodes.size(), kUnreached),
        centre_(patch.nodes.size(), kNowhere),
        source_(patch.nodes.size(), kNowhere),
        done_(patch.nodes.size(), 0),
        requeues_(patch.nodes.size(), 0),
        queue_(distance_) {}

  /// `start`: the distance of each source; empty: 0.
  std::vector<double> run(std::span<const std::uint32_t> sources, std::span<const double> start, double radius) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const std::uint32_t source = sources[i];
      if (source >= distance_.size() || centre_[source] != kNowhere) continue;
      distance_[source] = start.empty() ? 0 : start[i];
      centre_[source] = source_[source] = source;
      queue_.raise(source);
    }
    while (!queue_.empty()) {
      const std::uint32_t node = queue_.pop();
      if (distance_[node] > radius) break;
      done_[node] = 1;
      spread_from(node);
    }
    for (std::size_t i = 0; i < distance_.size(); ++i)
      if (done_[i] == 0) distance_[i] = kUnreached;
    return std::move(distance_);
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
    offer(to, distance_[from] + length, patch_.bends[from] != 0 ? from : centre_[from], source_[from]);
  }

  void cross(const Triangle& t) {
    if (done_[t.a] == 0 || done_[t.b] == 0 || !(t.base > 0)) return;
    if (done_[t.tip] != 0 && distance_[t.tip] <= std::min(distance_[t.a], distance_[t.b])) return;
    const double x = (t.a_tip * t.a_tip + t.base * t.base - t.b_tip * t.b_tip) / (2 * t.base);
    const FlatTip tip{x, std::sqrt(std::max(0.0, t.a_tip * t.a_tip - x * x))};
    const std::uint32_t centre = centre_[t.a];
    if (centre == centre_[t.b])
      cross_from_centre(t, tip, {centre, distance_[t.a] - distance_[centre], distance_[t.b] - distance_[centre]});
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
    const double distance = distance_[wave.centre] + std::sqrt(dx * dx + dy * dy);
    // no path along the surface is shorter than the straight line
    if (distance < distance_[t.tip]) offer(t.tip, std::max(distance, straight(wave.centre, t.tip)), wave.centre, source_[t.a]);
    return true;
  }

  /// Distance at a node by the straight line in space from a centre: a lower bound.
  double straight(std::uint32_t centre, std::uint32_t node) const {
    return distance_[centre] + (patch_.positions[node] - patch_.positions[centre]).norm();
  }

  /// Between waves of different sources the front counts as straight. Waves of one source with different centres meet behind a turn: the
  /// path to one end of the base passed the turn, the path to the other end, which the earlier centre still sees, didn't.
  void cross_between_waves(const Triangle& t, const FlatTip& tip) {
    const double slope_x = (distance_[t.b] - distance_[t.a]) / t.base;
    if (!(std::abs(slope_x) < 1)) return;
    const double slope_y = std::sqrt(1 - slope_x * slope_x);
    const double crossing = tip.x * slope_y - tip.y * slope_x;
    const std::uint32_t nearer = crossing < 0.5 * t.base * slope_y ? t.a : t.b;
    if (source_[t.a] == source_[t.b] && cross_behind_turn(t, tip)) return;
    if (crossing < 0 || crossing > t.base * slope_y) return;
    offer(t.tip, distance_[t.a] + tip.x * slope_x + tip.y * slope_y, centre_[nearer], source_[nearer]);
  }

  /// Tries the waves of both centres. At an end that a centre doesn't see, the radius of its wave is at least the distance found there, and
  /// at least the straight line in space.
  bool cross_behind_turn(const Triangle& t, const FlatTip& tip) {
    const auto over = [&](std::uint32_t centre) {
      return cross_from_centre(t, tip,
                               {centre, std::max(distance_[t.a], straight(centre, t.a)) - distance_[centre],
                                std::max(distance_[t.b], straight(centre, t.b)) - distance_[centre]});
    };
    const bool from_a = over(centre_[t.a]);
    const bool from_b = over(centre_[t.b]);
    return from_a || from_b;
  }

  /// Lowers a node's distance. A finished node is queued again if its distance gets lower: where corners are obtuse or the source is near,
  /// the ends of a base may be finished after the tip.
  void offer(std::uint32_t node, double distance, std::uint32_t centre, std::uint32_t source) {
    if (done_[node] != 0) {
      if (!(distance < distance_[node] * (1 - kMinGain)) || requeues_[node] == kMaxRequeues) return;
      ++requeues_[node];
    } else if (!(distance < distance_[node])) {
      return;
    }
    done_[node] = 0;
    distance_[node] = distance;
    centre_[node] = centre;
    source_[node] = source;
    queue_.raise(node);
  }

  const Patch& patch_;
  std::vector<double> distance_;
  std::vector<std::uint32_t> centre_;  ///< node that the wave spreads from in circles: a source, or the last turn of the path
  std::vector<std::uint32_t> source_;
  std::vector<std::uint8_t> done_;
  std::vector<std::uint8_t> requeues_;  ///< how often each node was queued again
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
