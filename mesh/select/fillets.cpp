#include "mesh/select/fillets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "mesh/model/features.h"

namespace prismesh::mesh::select {

namespace {

constexpr std::size_t kMaxRows = 8;
constexpr double kMinOfPeak = 0.3;    ///< a fillet's edge has at least this share of its greatest curvature
constexpr double kFlatOfPeak = 0.15;  ///< beside a fillet the curvature is at most this share

Vec3 face_normal(const Model& model, const ShellNodes& nodes) {
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(nodes.node[i]); };
  if (nodes.is_triangle()) return (at(1) - at(0)).cross(at(2) - at(0));
  return (at(2) - at(0)).cross(at(3) - at(1));
}

Edge edge_between(NodeIndex a, NodeIndex b) { return a < b ? Edge{a, b} : Edge{b, a}; }

/// Where a nodes' cycle has the edge: the position of its first end; 4 if it has no such edge.
std::size_t edge_position(const ShellNodes& nodes, Edge edge) {
  const auto corners = static_cast<std::size_t>(nodes.corners());
  for (std::size_t i = 0; i < corners; ++i) {
    const Edge here = edge_between(nodes.node[i], nodes.node[(i + 1) % corners]);
    if (here.low == edge.low && here.high == edge.high) return i;
  }
  return 4;
}

/// What one walk across opposite edges of quads found: the edges in order and how it ended.
struct Walk {
  struct Crossing {
    double degrees = 0;  ///< positive: towards the side of the normal at the start
    double curvature = 0;
  };
  std::array<Crossing, kMaxRows + 3> edges;
  std::size_t count = 0;
  bool at_end = false;  ///< the sheet ends behind the last edge: a free edge, a junction or a triangle
};

class RowWalker {
 public:
  RowWalker(const Model& model, OutOfSight out_of_sight) : model_(model), out_of_sight_(out_of_sight) {}

  /// Walks from a quad over its edge `position`.
  Walk from(ShellIndex shell, std::size_t position) const {
    Walk walk;
    Vec3 normal = face_normal(model_, model_.shell(shell));
    while (walk.count < walk.edges.size()) {
      const ShellNodes& nodes = model_.shell(shell);
      const NodeIndex from = nodes.node[position], to = nodes.node[(position + 1) % 4];
      const ShellIndex beyond = only_neighbour(shell, from, to);
      if (!beyond.valid()) break;
      const Edge edge = edge_between(from, to);
      const Bend bend = bend_between(model_, shell, beyond, edge);
      const double degrees = bend.beyond.dot(normal) < 0 ? -bend.degrees : bend.degrees;
      walk.edges[walk.count++] = {degrees, bend.width > 0 ? degrees / bend.width : 0};
      const ShellNodes& other = model_.shell(beyond);
      if (other.is_triangle()) break;
      const std::size_t there = edge_position(other, edge);
      // neighbours run along their common edge in opposite directions if their normals agree
      const bool agrees = other.node[there] == to;
      const bool turned = face_normal(model_, nodes).dot(normal) < 0;
      normal = face_normal(model_, other) * (agrees != turned ? 1.0 : -1.0);
      shell = beyond;
      position = (there + 2) % 4;
    }
    walk.at_end = walk.count < walk.edges.size();
    return walk;
  }

 private:
  /// The one other visible shell at an edge; invalid at a free edge or junction.
  ShellIndex only_neighbour(ShellIndex shell, NodeIndex from, NodeIndex to) const {
    ShellIndex found;
    if (from == to) return found;
    for (const ShellIndex other : model_.adjacency->shells_of(model_.adjacency->find_edge(from, to))) {
      if (other == shell || !in_sight(model_, other, out_of_sight_)) continue;
      if (found.valid()) return {};
      found = other;
    }
    return found;
  }

  const Model& model_;
  OutOfSight out_of_sight_;
};

/// The two walks from a quad over opposite edges, and the run of edges around it that bend alike.
class Run {
 public:
  Run(const Walk& one, const Walk& other) : walks_{one, other} {}

  /// Whether this is a fillet that bends by more than the angle.
  bool is_fillet(double angle_degrees) {
    if (walks_[0].count == 0 || walks_[1].count == 0) return false;
    side_ = walks_[0].edges[0].degrees < 0 ? -1 : 1;
    if (!(curvature(0, 0) > 0 && curvature(1, 0) > 0)) return false;
    if (!find_ends()) return false;
    if (length_[0] + length_[1] - 1 > kMaxRows) return false;
    const Beside beside[] = {beyond(0), beyond(1)};
    const auto is = [&](Beside what) { return beside[0] == what || beside[1] == what; };
    return !is(Beside::bent) && is(Beside::flat) && total_degrees() > angle_degrees;
  }

 private:
  enum class Beside : std::uint8_t { flat, ends_or_bends_back, bent };

  double curvature(std::size_t walk, std::size_t edge) const { return side_ * walks_[walk].edges[edge].curvature; }

  /// Sets length_ and peak_; false if the quad itself isn't between two edges of the run.
  bool find_ends() {
    peak_ = std::max(curvature(0, 0), curvature(1, 0));
    length_ = {1, 1};
    for (bool more = true; more;) {
      more = false;
      for (const std::size_t walk : {0, 1})
        while (length_[walk] < walks_[walk].count && curvature(walk, length_[walk]) >= kMinOfPeak * peak_) {
          peak_ = std::max(peak_, curvature(walk, length_[walk]++));
          more = true;
        }
    }
    // the peak may have grown beyond what the edges before it allow
    for (const std::size_t walk : {0, 1})
      for (std::size_t i = 0; i < length_[walk]; ++i)
        if (curvature(walk, i) < kMinOfPeak * peak_) length_[walk] = i;
    return length_[0] > 0 && length_[1] > 0;
  }

  Beside beyond(std::size_t walk) const {
    const std::size_t next = length_[walk];
    if (next == walks_[walk].count) return walks_[walk].at_end ? Beside::ends_or_bends_back : Beside::bent;
    if (curvature(walk, next) < -kMinOfPeak * peak_) return Beside::ends_or_bends_back;
    const bool is_last = next + 1 == walks_[walk].count;
    if (std::abs(curvature(walk, is_last ? next : next + 1)) <= kFlatOfPeak * peak_) return Beside::flat;
    return is_last && walks_[walk].at_end ? Beside::ends_or_bends_back : Beside::bent;
  }

  double total_degrees() const {
    double total = 0;
    for (const std::size_t walk : {0, 1})
      for (std::size_t i = 0; i < length_[walk]; ++i) total += side_ * walks_[walk].edges[i].degrees;
    return total;
  }

  std::array<Walk, 2> walks_;
  double side_ = 1;
  std::array<std::size_t, 2> length_{};  ///< edges of the run on each side
  double peak_ = 0;
};

}  // namespace

Fillets::Fillets(const Model& model, double angle_degrees, OutOfSight out_of_sight)
    : model_(model), angle_degrees_(angle_degrees), out_of_sight_(out_of_sight), known_(model.shell_count(), 0) {}

int Fillets::directions(ShellIndex shell) {
  std::uint8_t& known = known_[shell.value];
  if (known == 0) {
    int found = 0;
    const RowWalker walker(model_, out_of_sight_);
    if (!model_.shell(shell).is_triangle())
      for (const std::size_t first : {0, 1})
        if (Run(walker.from(shell, first), walker.from(shell, first + 2)).is_fillet(angle_degrees_)) found |= 1 << first;
    known = static_cast<std::uint8_t>(4 + found);
  }
  return known - 4;
}

bool Fillets::bends_across(ShellIndex shell, Edge edge) {
  const int found = directions(shell);
  if (found == 0) return false;
  const std::size_t position = edge_position(model_.shell(shell), edge);
  return position < 4 && (found >> (position % 2) & 1) != 0;
}

}  // namespace prismesh::mesh::select
