#include "tests/mesh/spatial/exact_geodesic.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <utility>

#include <Eigen/Geometry>

namespace prismesh::test {

namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTie = 1e-12;  ///< share of a distance below which two paths are equally long

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A triangle seen from one of its sides: `from` lies at the origin, `to` on the x axis, `tip` above it.
struct Side {
  std::uint32_t from = 0, to = 0, tip = 0;
  double length = 0;
  Vec2 tip_at = Vec2::Zero();
  std::vector<std::uint32_t> beyond;  ///< the sides of other triangles at the same edge
};

/// Straight paths from one source that enter a triangle through part of a side.
struct Window {
  std::uint32_t side = 0;      ///< 3 * triangle + which of its sides
  double begin = 0, end = 0;   ///< of the part, along the side
  Vec2 source = Vec2::Zero();  ///< unfolded into the triangle's plane, below the x axis
  double before = 0;           ///< length of the path to that source

  double nearest() const { return before + Vec2(std::clamp(source.x(), begin, end) - source.x(), source.y()).norm(); }
  double to(const Vec2& point) const { return before + (point - source).norm(); }
};

class Windows {
 public:
  Windows(const TriangleSurface& surface, double radius)
      : surface_(surface),
        radius_(radius),
        distance_(surface.point.size(), kInfinity),
        turns_(surface.point.size(), 0),
        at_point_(surface.point.size()),
        nearest_over_(3 * surface.triangle.size(), {kInfinity, 0.0}) {
    find_sides();
    find_turns();
  }

  std::vector<double> run(std::span<const std::uint32_t> sources) {
    for (const std::uint32_t source : sources) {
      turns_[source] = 1;
      improve(source, 0);
    }
    while (!queue_.empty()) {
      const Event event = queue_.top();
      queue_.pop();
      if (event.nearest > radius_) break;
      if (event.window == kPoint) {
        if (event.nearest == distance_[event.point]) spread_from_point(event.point);
        continue;
      }
      const Window window = windows_[event.window];
      unused_.push_back(event.window);
      if (!is_beaten(window)) pass(window);
    }
    for (double& d : distance_)
      if (d > radius_) d = kInfinity;
    return distance_;
  }

 private:
  static constexpr std::uint32_t kPoint = 0xffffffffu;
  struct Event {
    double nearest;
    std::uint32_t window;  ///< kPoint: a point's event
    std::uint32_t point;
    bool operator>(const Event& other) const { return nearest > other.nearest; }
  };

  double length(std::uint32_t a, std::uint32_t b) const { return (surface_.point[a] - surface_.point[b]).norm(); }

  void find_sides() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> at_edge;
    for (const auto& t : surface_.triangle)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = t[i], to = t[(i + 1) % 3], tip = t[(i + 2) % 3];
        at_point_[from].push_back(static_cast<std::uint32_t>(sides_.size()));
        at_edge[std::minmax(from, to)].push_back(static_cast<std::uint32_t>(sides_.size()));
        const Eigen::Vector3d along = surface_.point[to] - surface_.point[from];
        const Eigen::Vector3d to_tip = surface_.point[tip] - surface_.point[from];
        const double whole = along.norm();
        sides_.push_back({from, to, tip, whole, {to_tip.dot(along) / whole, to_tip.cross(along).norm() / whole}, {}});
      }
    for (const auto& [ends, sides] : at_edge)
      for (const std::uint32_t side : sides) {
        if (sides.size() != 2) turns_[ends.first] = turns_[ends.second] = 1;
        for (const std::uint32_t other : sides)
          if (other != side) sides_[side].beyond.push_back(other);
      }
  }

  /// A shortest path has a bend only where the surface around it is a saddle, ends or branches.
  void find_turns() {
    for (std::uint32_t p = 0; p < surface_.point.size(); ++p) {
      double sum = 0;
      for (const std::uint32_t side : at_point_[p]) sum += std::atan2(sides_[side].tip_at.y(), sides_[side].tip_at.x());
      if (sum > 2 * M_PI + 1e-9) turns_[p] = 1;
    }
  }

  void improve(std::uint32_t point, double distance) {
    if (!(distance < distance_[point])) return;
    distance_[point] = distance;
    if (turns_[point] != 0) queue_.push({distance, kPoint, point});
  }

  void add(const Window& window) {
    if (!(window.end - window.begin > 1e-13 * sides_[window.side].length) || is_beaten(window)) return;
    auto place = static_cast<std::uint32_t>(windows_.size());
    if (unused_.empty()) {
      windows_.push_back(window);
    } else {
      place = unused_.back();
      unused_.pop_back();
      windows_[place] = window;
    }
    queue_.push({window.nearest(), place, 0});
  }

  /// Xin and Wang's filter: the path over an end of the side to the window's other end is shorter, and so it is to all between.
  bool is_beaten(const Window& w) const {
    const Side& side = sides_[w.side];
    return distance_[side.from] + w.end < w.to({w.end, 0}) * (1 - kTie) ||
           distance_[side.to] + side.length - w.begin < w.to({w.begin, 0}) * (1 - kTie);
  }

  void spread_from_point(std::uint32_t point) {
    for (const std::uint32_t near : at_point_[point]) {
      const Side& side = sides_[near];
      improve(side.to, distance_[point] + side.length);
      improve(side.tip, distance_[point] + length(point, side.tip));
      // the far side; the point lies to one side of it, the next triangles to the other
      const std::uint32_t far = next_of(near);
      const Vec2& from = sides_[far].tip_at;
      hand_on(far, false, 0, sides_[far].length, {from.x(), -from.y()}, distance_[point]);
    }
  }

  static std::uint32_t next_of(std::uint32_t side) { return side % 3 == 2 ? side - 2 : side + 1; }

  /// A window that leaves a triangle over one of its sides enters all other triangles there. `backwards`: what is given counts from
  /// the side's end.
  void hand_on(std::uint32_t over, bool backwards, double begin, double end, const Vec2& source, double before) {
    const Side& side = sides_[over];
    for (const std::uint32_t other : side.beyond) {
      if (sides_[other].from == (backwards ? side.to : side.from))
        add({other, begin, end, source, before});
      else
        add({other, side.length - end, side.length - begin, {side.length - source.x(), source.y()}, before});
    }
  }

  /// Carries a window over its triangle to the two other sides.
  void pass(const Window& w) {
    const Vec2 tip = sides_[w.side].tip_at;
    const double scale = (tip - w.source).norm() * sides_[w.side].length;
    const double beside_begin = cross(Vec2(w.begin, 0) - w.source, tip - w.source);  // > 0: the tip is left of all paths
    const double beside_end = cross(Vec2(w.end, 0) - w.source, tip - w.source);      // < 0: right of all
    if (beside_begin > 1e-12 * scale) return leave_right(w, w.begin, w.end);
    if (beside_end < -1e-12 * scale) return leave_left(w, w.begin, w.end);
    const double at_tip = w.to(tip);
    improve(sides_[w.side].tip, at_tip);
    const double share = -w.source.y() / (tip.y() - w.source.y());
    const double through = std::clamp(w.source.x() + share * (tip.x() - w.source.x()), w.begin, w.end);
    // another window that reaches the tip by a shorter path beats this one wherever this one's paths cross that path
    auto& [best, best_through] = nearest_over_[w.side];
    if (at_tip < best) {
      best = at_tip;
      best_through = through;
    }
    const bool beaten = best < at_tip * (1 - kTie);
    leave_left(w, w.begin, beaten ? std::min(through, best_through) : through);
    leave_right(w, beaten ? std::max(through, best_through) : through, w.end);
  }

  /// Where the path that enters at x leaves over the line from the origin along `direction` (a unit vector), as a length from the origin.
  static double leaves_at(const Window& w, double x, const Vec2& origin, const Vec2& direction) {
    const Vec2 way = Vec2(x, 0) - w.source;
    return cross(w.source - origin, way) / cross(direction, way);
  }

  void leave_left(const Window& w, double begin, double end) {
    const Vec2& tip = sides_[w.side].tip_at;
    leave(w, begin, end, next_of(next_of(w.side)), Vec2::Zero(), tip);
  }
  void leave_right(const Window& w, double begin, double end) {
    const Side& side = sides_[w.side];
    leave(w, begin, end, next_of(w.side), side.tip_at, {side.length, 0});
  }

  void leave(const Window& w, double begin, double end, std::uint32_t over, const Vec2& a, const Vec2& b) {
    if (!(begin < end)) return;
    const double whole = sides_[over].length;
    const Vec2 u = (b - a) / whole;
    const double from = std::clamp(leaves_at(w, begin, a, u), 0.0, whole);
    const double to = std::clamp(leaves_at(w, end, a, u), 0.0, whole);
    hand_on(over, true, from, to, {(w.source - a).dot(u), cross(u, w.source - a)}, w.before);
  }

  const TriangleSurface& surface_;
  double radius_;
  std::vector<double> distance_;
  std::vector<std::uint8_t> turns_;
  std::vector<Side> sides_;                              ///< 3 of each triangle, one after the other
  std::vector<std::vector<std::uint32_t>> at_point_;     ///< the sides that begin there
  std::vector<std::pair<double, double>> nearest_over_;  ///< by side entered: least distance of its tip, and where that path entered
  std::vector<Window> windows_;
  std::vector<std::uint32_t> unused_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> queue_;
};

}  // namespace

std::vector<double> exact_geodesic(const TriangleSurface& surface, std::span<const std::uint32_t> sources, double radius) {
  return Windows(surface, radius).run(sources);
}

}  // namespace prismesh::test
