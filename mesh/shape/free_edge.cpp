#include "mesh/shape/free_edge.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::shape {

namespace {

constexpr double kConvexCorner = 135 / kDegreesPerRadian;
constexpr double kReflexCorner = 250 / kDegreesPerRadian;  // above the 240 degrees at a node of a six-node hole, which is no corner

/// Sum of the shells' angles at a node: 180 degrees at a straight boundary, however the sheet is bent in space.
double surrounding_angle(const Model& model, NodeIndex node) {
  double angle = 0;
  for (const ShellIndex index : model.adjacency->shells_of(node)) {
    const ShellNodes& shell = model.shell(index);
    const int corners = shell.corners();
    const int at = static_cast<int>(std::find(shell.node.begin(), shell.node.begin() + corners, node) - shell.node.begin());
    const Vec3 next = model.position(shell.node[(at + 1) % corners]) - model.position(node);
    const Vec3 previous = model.position(shell.node[(at + corners - 1) % corners]) - model.position(node);
    angle += deterministic_atan2(next.cross(previous).norm(), next.dot(previous));
  }
  return angle;
}

}  // namespace

int free_edges_at(const Model& model, NodeIndex node, std::array<NodeIndex, 2>& ends) {
  const Adjacency& adjacency = *model.adjacency;
  int count = 0;
  for (const ShellIndex index : adjacency.shells_of(node)) {
    const ShellNodes& shell = model.shell(index);
    const int corners = shell.corners();
    const int at = static_cast<int>(std::find(shell.node.begin(), shell.node.begin() + corners, node) - shell.node.begin());
    for (const NodeIndex other : {shell.node[(at + 1) % corners], shell.node[(at + corners - 1) % corners]}) {
      const EdgeIndex edge = adjacency.find_edge(node, other);
      if (!edge.valid() || adjacency.shells_of(edge).size() != 1) continue;
      if (count < 2) ends[static_cast<std::size_t>(count)] = other;
      ++count;
    }
  }
  return count;
}

bool is_boundary_corner(const Model& model, NodeIndex node) {
  const double angle = surrounding_angle(model, node);
  return angle < kConvexCorner || angle > kReflexCorner;
}

FreeEdges::FreeEdges(const Model& model, const NodeSet& selection) : model_(model), selection_(selection) {
  const Adjacency& adjacency = *model.adjacency;
  std::vector<std::array<std::uint32_t, 2>> ends;
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const std::uint32_t node = selection[i].value;
    for (std::uint32_t e = adjacency.edge_first[node]; e < adjacency.edge_first[node + 1]; ++e) {
      if (adjacency.edge_shell_first[e + 1] - adjacency.edge_shell_first[e] != 1) continue;
      const auto high = std::lower_bound(selection.begin(), selection.end(), adjacency.edge_high[e]);
      if (high == selection.end() || *high != adjacency.edge_high[e]) continue;
      const auto low = static_cast<std::uint32_t>(i);
      const auto other = static_cast<std::uint32_t>(high - selection.begin());
      ends.push_back({low, other});
      ends.push_back({other, low});
    }
  }
  std::sort(ends.begin(), ends.end());
  first_.assign(selection.size() + 1, 0);
  for (const auto& end : ends) ++first_[end[0] + 1];
  for (std::size_t i = 0; i < selection.size(); ++i) first_[i + 1] += first_[i];
  neighbours_.reserve(ends.size());
  for (const auto& end : ends) neighbours_.push_back(end[1]);
}

bool FreeEdges::is_corner(std::uint32_t node) const {
  if (neighbours(node).size() != 2) return true;
  return is_boundary_corner(model_, selection_[node]);
}

FreeEdges::Line FreeEdges::walk(std::uint32_t from, std::uint32_t to, std::span<const std::uint8_t> border) const {
  Line nodes{from, to};
  while (nodes.back() != from && border[nodes.back()] == 0 && !is_corner(nodes.back())) {
    const auto both = neighbours(nodes.back());
    nodes.push_back(both[0] == nodes[nodes.size() - 2] ? both[1] : both[0]);
  }
  return nodes;
}

std::vector<FreeEdges::Line> FreeEdges::lines_through(std::uint32_t node, std::span<const std::uint8_t> border) const {
  std::vector<Line> lines;
  for (const std::uint32_t next : neighbours(node)) lines.push_back(walk(node, next, border));
  const auto reaches_border = [&](const auto& line) { return border[line.back()] != 0; };
  if (is_corner(node) && !std::all_of(lines.begin(), lines.end(), reaches_border)) std::erase_if(lines, reaches_border);
  return lines;
}

std::vector<std::uint32_t> FreeEdges::through(std::uint32_t node, std::span<const std::uint8_t> border) const {
  std::vector<std::uint32_t> nodes{node};
  for (const Line& line : lines_through(node, border)) nodes.insert(nodes.end(), line.begin(), line.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::size_t FreeEdges::count_held_lines(std::uint32_t node, std::span<const std::uint8_t> border) const {
  const std::vector<Line> lines = lines_through(node, border);
  return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](const Line& line) { return border[line.back()] != 0; }));
}

std::vector<std::uint8_t> FreeEdges::on_holes(std::span<const std::uint8_t> border) const {
  constexpr double kHalfTurn = 180 / kDegreesPerRadian;
  std::vector<std::uint8_t> holes(first_.size() - 1, 0);
  std::vector<std::uint8_t> seen(holes.size(), 0);
  for (std::uint32_t first = 0; first < seen.size(); ++first) {
    if (seen[first] != 0 || !touches(first)) continue;
    Line line{first};
    seen[first] = 1;
    bool closed = true;
    double turn = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      closed = closed && neighbours(line[i]).size() == 2 && border[line[i]] == 0;
      turn += kHalfTurn - surrounding_angle(model_, selection_[line[i]]);
      for (const std::uint32_t next : neighbours(line[i])) {
        if (seen[next] != 0) continue;
        seen[next] = 1;
        line.push_back(next);
      }
    }
    if (closed && turn < -kHalfTurn)
      for (const std::uint32_t node : line) holes[node] = 1;
  }
  return holes;
}

}  // namespace prismesh::mesh::shape
