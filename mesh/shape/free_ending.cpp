#include "mesh/shape/free_ending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "mesh/spatial/geodesic.h"

namespace prismesh::mesh::shape {

namespace {

using spatial::corner_count;
using spatial::Patch;
using Corners = std::array<std::uint32_t, 4>;

constexpr double kDistanceTolerance = 1e-9;  ///< share of the distance that counts as on the line: rounding
constexpr double kAxisTolerance = 0.01;      ///< in mean element sides: decks round coordinates
constexpr double kMinDirection = 1e-3;       ///< of a mean of unit vectors, to count as a direction

std::span<const std::uint32_t> shells_at(const Patch& patch, std::uint32_t node) {
  return std::span(patch.node_shells).subspan(patch.node_first[node], patch.node_first[node + 1] - patch.node_first[node]);
}

/// Calls visit(next) for the other nodes of the node's shells.
void for_neighbours(const Patch& patch, std::uint32_t node, const auto& visit) {
  for (const std::uint32_t shell : shells_at(patch, node))
    for (const std::uint32_t next : patch.shells[shell])
      if (next != node) visit(shell, next);
}

/// Marks what is reached from the nodes in `open` where passes(from, shell, to) allows it.
void flood(const Patch& patch, std::vector<std::uint32_t> open, std::vector<std::uint8_t>& reached, const auto& passes) {
  for (const std::uint32_t node : open) reached[node] = 1;
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    for_neighbours(patch, node, [&](std::uint32_t shell, std::uint32_t next) {
      if (reached[next] != 0 || !passes(node, shell, next)) return;
      reached[next] = 1;
      open.push_back(next);
    });
  }
}

/// The pieces of a line: a number from 1 for each shell that it touches, 0 for the others. Shells that share a node belong together.
std::vector<std::uint32_t> number_pieces(const Patch& patch, const CutLine& line) {
  const auto touches = [&](std::uint32_t shell) {
    bool before = false, beyond = false, on = false;
    for (const std::uint32_t node : patch.shells[shell]) {
      before = before || line.before(node);
      beyond = beyond || line.beyond(node);
      on = on || line.on_line(node);
    }
    return on || (before && beyond);
  };
  std::vector<std::uint32_t> piece(patch.shells.size(), 0);
  std::uint32_t count = 0;
  for (std::uint32_t first = 0; first < piece.size(); ++first) {
    if (piece[first] != 0 || !touches(first)) continue;
    piece[first] = ++count;
    std::vector<std::uint32_t> open{first};
    while (!open.empty()) {
      const Corners corners = patch.shells[open.back()];
      open.pop_back();
      for (const std::uint32_t node : corners)
        for (const std::uint32_t next : shells_at(patch, node))
          if (piece[next] == 0 && touches(next)) {
            piece[next] = count;
            open.push_back(next);
          }
    }
  }
  return piece;
}

/// Twice the area of a triangle times the gradient of what grows linearly between the values at its corners; zero for no area.
Vec3 gradient_times_area(const std::array<Vec3, 3>& at, const std::array<double, 3>& value) {
  const Vec3 u = at[1] - at[0];
  const Vec3 v = at[2] - at[0];
  const double area = u.cross(v).norm();
  if (!(area > 0)) return Vec3::Zero();
  const double du = value[1] - value[0];
  const double dv = value[2] - value[0];
  return (du * (v.squaredNorm() * u - u.dot(v) * v) + dv * (u.squaredNorm() * v - u.dot(v) * u)) / area;
}

double mean_side(const Patch& patch) {
  double sum = 0;
  std::size_t count = 0;
  for (const Corners& corner : patch.shells) {
    const int corners = corner_count(corner);
    for (int i = 0; i < corners && corners > 2; ++i) {
      const double side = (patch.positions[corner[(i + 1) % corners]] - patch.positions[corner[i]]).norm();
      if (!std::isfinite(side)) continue;
      sum += side;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Where the axis is: distances of nodes from it, and the shells nearest to it.
class AxisPlace {
 public:
  AxisPlace(const Patch& patch, std::span<const std::uint8_t> connected, const Axis& axis)
      : patch_(patch), axis_(axis), side_(mean_side(patch)), away_(patch.nodes.size(), std::numeric_limits<double>::infinity()) {
    for (std::size_t i = 0; i < away_.size(); ++i) {
      if (connected[i] == 0) continue;
      const double away = across(patch.positions[i] - axis.point).norm();
      if (std::isfinite(away)) away_[i] = away;
    }
    for (const double away : away_) least_ = std::min(least_, away);
  }

  Vec3 across(const Vec3& vector) const { return vector - vector.dot(axis_.direction) * axis_.direction; }
  double side() const { return side_; }

  double away(std::uint32_t shell) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t node : patch_.shells[shell]) least = std::min(least, away_[node]);
    return least;
  }

  /// The mean unit direction, across the axis, in which the distance from the border grows at the shells near the axis.
  std::optional<Vec3> outward(std::span<const double> from_border) const {
    Vec3 sum = Vec3::Zero();
    double area = 0;
    for (std::uint32_t shell = 0; shell < patch_.shells.size(); ++shell) {
      const Corners& corner = patch_.shells[shell];
      if (!(away(shell) <= least_ + side_)) continue;
      for (int i = 2; i < corner_count(corner); ++i) {
        const std::array<std::uint32_t, 3> node{corner[0], corner[i - 1], corner[i]};
        const std::array<Vec3, 3> at{patch_.positions[node[0]], patch_.positions[node[1]], patch_.positions[node[2]]};
        const Vec3 part = gradient_times_area(at, {from_border[node[0]], from_border[node[1]], from_border[node[2]]});
        if (!part.allFinite()) continue;
        sum += across(part);
        area += (at[1] - at[0]).cross(at[2] - at[0]).norm();
      }
    }
    const double length = sum.norm();
    if (!(length > kMinDirection * area) || !std::isfinite(length)) return std::nullopt;
    return Vec3(sum / length);
  }

 private:
  const Patch& patch_;
  const Axis& axis_;
  double side_;
  std::vector<double> away_;
  double least_ = std::numeric_limits<double>::infinity();
};

/// Decides which nodes beyond a line belong to free endings.
class Endings {
 public:
  Endings(const Patch& patch, const FreeEdges& free_edges, std::span<const std::uint8_t> border, const CutLine& line)
      : patch_(patch),
        free_edges_(free_edges),
        border_(border),
        line_(line),
        holes_(free_edges.on_holes(border)),
        taken_by_(patch.nodes.size(), 0) {}

  std::vector<std::uint8_t> find(std::span<const std::uint8_t> connected) {
    std::vector<std::uint8_t> seen = reached_from_border(connected);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (connected[i] == 0) seen[i] = 1;
    std::vector<std::uint8_t> endings(seen.size(), 0);
    for (std::uint32_t first = 0; first < seen.size(); ++first) {
      if (seen[first] != 0) continue;
      std::vector<std::uint32_t> piece = piece_at(first, seen);
      if (!is_ending(piece)) continue;
      for (const std::uint32_t node : piece) endings[node] = 1;
    }
    return endings;
  }

 private:
  bool at_line(std::uint32_t node) const {
    const auto shells = shells_at(patch_, node);
    return line_.on_line(node) && std::any_of(shells.begin(), shells.end(), [&](std::uint32_t shell) { return line_.shells[shell] != 0; });
  }

  std::vector<std::uint8_t> reached_from_border(std::span<const std::uint8_t> connected) const {
    std::vector<std::uint32_t> sources;
    for (std::uint32_t i = 0; i < connected.size(); ++i)
      if (connected[i] != 0 && border_[i] != 0) sources.push_back(i);
    std::vector<std::uint8_t> reached(connected.size(), 0);
    flood(patch_, std::move(sources), reached, [&](std::uint32_t from, std::uint32_t shell, std::uint32_t to) {
      if (at_line(from)) return false;
      return line_.shells[shell] == 0 || line_.before(from) == line_.before(to) || line_.on_line(to);
    });
    return reached;
  }

  /// The unseen nodes connected to `first`, marked as seen, and the nodes of the line at them and along it.
  std::vector<std::uint32_t> piece_at(std::uint32_t first, std::vector<std::uint8_t>& seen) {
    std::vector<std::uint32_t> piece{first};
    const std::uint32_t number = first + 1;
    seen[first] = 1;
    taken_by_[first] = number;
    for (std::size_t next = 0; next < piece.size(); ++next)
      for_neighbours(patch_, piece[next], [&](std::uint32_t, std::uint32_t node) {
        if (taken_by_[node] == number || (seen[node] != 0 && (border_[node] != 0 || !at_line(node)))) return;
        seen[node] = 1;
        taken_by_[node] = number;
        piece.push_back(node);
      });
    std::sort(piece.begin(), piece.end());
    return piece;
  }

  bool is_ending(const std::vector<std::uint32_t>& piece) const {
    const double free = length_of_free_edges(piece);
    return free > 0 && free >= kMinFreeShare * length_of_cut(piece);
  }

  double length_of_free_edges(const std::vector<std::uint32_t>& piece) const {
    double length = 0;
    for (const std::uint32_t node : piece)
      for (const std::uint32_t other : free_edges_.neighbours(node)) {
        if (other < node || (holes_[node] != 0 && holes_[other] != 0)) continue;
        if (std::binary_search(piece.begin(), piece.end(), other)) length += (patch_.positions[other] - patch_.positions[node]).norm();
      }
    return length;
  }

  double length_of_cut(const std::vector<std::uint32_t>& piece) const {
    std::vector<std::uint32_t> shells;
    for (const std::uint32_t node : piece)
      for (const std::uint32_t shell : shells_at(patch_, node))
        if (line_.shells[shell] != 0) shells.push_back(shell);
    std::sort(shells.begin(), shells.end());
    shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
    double length = 0;
    for (const std::uint32_t shell : shells) length += cut_length(patch_.shells[shell], piece);
    return length;
  }

  /// The distance between the two points where the piece ends on the shell's sides.
  double cut_length(const Corners& corner, const std::vector<std::uint32_t>& piece) const {
    const int corners = corner_count(corner);
    const auto inside = [&](std::uint32_t node) { return std::binary_search(piece.begin(), piece.end(), node); };
    std::vector<Vec3> ends;
    for (int i = 0; i < corners && corners > 2; ++i) {
      const std::uint32_t a = corner[i];
      const std::uint32_t b = corner[(i + 1) % corners];
      if (inside(a) == inside(b)) continue;
      const double over_a = std::abs(line_.height[a]);
      const double over_b = std::abs(line_.height[b]);
      const double share = over_a + over_b > 0 ? over_a / (over_a + over_b) : 0.5;
      ends.push_back(patch_.positions[a] + share * (patch_.positions[b] - patch_.positions[a]));
    }
    return ends.size() < 2 ? 0 : (ends[1] - ends[0]).norm();
  }

  const Patch& patch_;
  const FreeEdges& free_edges_;
  std::span<const std::uint8_t> border_;
  const CutLine& line_;
  std::vector<std::uint8_t> holes_;
  std::vector<std::uint32_t> taken_by_;  ///< of each node: the number of the last piece that has it
};

}  // namespace

std::vector<std::uint8_t> connected_to(const Patch& patch, std::uint32_t start) {
  std::vector<std::uint8_t> connected(patch.nodes.size(), 0);
  flood(patch, {start}, connected, [](std::uint32_t, std::uint32_t, std::uint32_t) { return true; });
  return connected;
}

CutLine cut_at_distance(const Patch& patch, std::span<const double> from_border, double distance, std::span<const std::uint32_t> origin) {
  CutLine line;
  line.tolerance = kDistanceTolerance * distance;
  for (const double d : from_border) line.height.push_back(d < spatial::kUnreached ? d - distance : std::nan(""));
  const std::vector<std::uint32_t> piece = number_pieces(patch, line);
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t node : origin)
    if (line.on_line(node))
      for (const std::uint32_t shell : shells_at(patch, node)) chosen.push_back(piece[shell]);
  std::sort(chosen.begin(), chosen.end());
  for (const std::uint32_t number : piece) line.shells.push_back(number != 0 && std::binary_search(chosen.begin(), chosen.end(), number));
  return line;
}

std::optional<CutLine> cut_at_axis(const Patch& patch, std::span<const double> from_border, std::span<const std::uint8_t> connected,
                                   const Axis& axis) {
  const AxisPlace place(patch, connected, axis);
  const std::optional<Vec3> outward = place.outward(from_border);
  if (!outward) return std::nullopt;
  CutLine line;
  line.tolerance = kAxisTolerance * place.side();
  for (std::size_t i = 0; i < patch.nodes.size(); ++i)
    line.height.push_back(connected[i] != 0 ? outward->dot(patch.positions[i] - axis.point) : std::nan(""));
  const std::vector<std::uint32_t> piece = number_pieces(patch, line);
  std::vector<double> away(1 + (piece.empty() ? 0 : *std::max_element(piece.begin(), piece.end())),
                           std::numeric_limits<double>::infinity());
  for (std::uint32_t shell = 0; shell < piece.size(); ++shell)
    if (piece[shell] != 0) away[piece[shell]] = std::min(away[piece[shell]], place.away(shell));
  const double nearest = *std::min_element(away.begin(), away.end());
  for (const std::uint32_t number : piece) line.shells.push_back(number != 0 && away[number] <= nearest + place.side());
  return line;
}

std::vector<std::uint8_t> find_free_endings(const Patch& patch, const FreeEdges& free_edges, std::span<const std::uint8_t> connected,
                                            std::span<const std::uint8_t> border, const CutLine& line) {
  return Endings(patch, free_edges, border, line).find(connected);
}

std::vector<std::pair<std::uint32_t, double>> distances_before(const Patch& patch, const CutLine& line,
                                                               std::span<const std::uint8_t> marked) {
  std::vector<std::pair<std::uint32_t, double>> before;
  for (std::uint32_t shell = 0; shell < patch.shells.size(); ++shell) {
    const Corners& corner = patch.shells[shell];
    const int corners = corner_count(corner);
    if (line.shells[shell] == 0 || corners < 3) continue;
    if (std::none_of(corner.begin(), corner.end(), [&](std::uint32_t node) { return marked[node] != 0; })) continue;
    for (int i = 0; i < corners; ++i) {
      const std::uint32_t node = corner[i];
      if (marked[node] != 0 || !line.before(node)) continue;
      const std::uint32_t next = corner[(i + 1) % corners];
      const std::uint32_t previous = corner[(i + corners - 1) % corners];
      const std::array<Vec3, 3> at{patch.positions[node], patch.positions[next], patch.positions[previous]};
      const double area = (at[1] - at[0]).cross(at[2] - at[0]).norm();
      const double slope = gradient_times_area(at, {line.height[node], line.height[next], line.height[previous]}).norm() / area;
      const double distance = -line.height[node] / slope;
      if (std::isfinite(distance)) before.emplace_back(node, distance);
    }
  }
  // of each node the least
  std::sort(before.begin(), before.end());
  before.erase(std::unique(before.begin(), before.end(), [](const auto& a, const auto& b) { return a.first == b.first; }), before.end());
  return before;
}

}  // namespace prismesh::mesh::shape
