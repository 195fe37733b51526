#include "mesh/select/cells.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"

namespace prismesh::mesh::select {
namespace {

constexpr double kMinShape = 0.3;  ///< sine of the smallest angle of two triangles that count as a quad
constexpr double kEqual = 1e-9;
constexpr std::uint32_t kNotAsked = 0xffffffffu, kNone = 0xfffffffeu;  ///< of Cells::partner_
constexpr std::uint8_t kUnknown = 0, kFlat = 1, kBends = 2;            ///< of Cells::flat_

Vec3 centre_of(const Model& model, const Cell& cell) {
  Vec3 sum = Vec3::Zero();
  for (const NodeIndex node : cell.node) sum += model.position(node);
  return sum / 4;
}

Vec3 normal_of(const Model& model, const Cell& cell) {
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(cell.node[i]); };
  return (at(2) - at(0)).cross(at(3) - at(1));
}

/// The sine of the smallest angle of a quad; 0 or less if it isn't convex.
double shape_of(const Model& model, const std::array<NodeIndex, 4>& nodes) {
  const auto at = [&](std::size_t i) -> const Vec3& { return model.position(nodes[i % 4]); };
  const Vec3 normal = (at(2) - at(0)).cross(at(3) - at(1));
  const double length = normal.norm();
  double smallest = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 ahead = at(i + 1) - at(i), back = at(i + 3) - at(i);
    const double product = std::sqrt(ahead.squaredNorm() * back.squaredNorm()) * length;
    smallest = std::min(smallest, product > 0 ? ahead.cross(back).dot(normal) / product : 0.0);
  }
  return smallest;
}

Vec3 centre_of(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < nodes.corners(); ++i) sum += model.position(nodes.node[static_cast<std::size_t>(i)]);
  return sum / nodes.corners();
}

bool has_node(const ShellNodes& of, NodeIndex node) {
  const auto end = of.node.begin() + of.corners();
  return std::find(of.node.begin(), end, node) != end;
}

}  // namespace

Cells::Cells(const Model& model, OutOfSight out_of_sight)
    : model_(model),
      out_of_sight_(out_of_sight),
      partner_(model.shell_count(), kNotAsked),
      flat_(model.adjacency->edge_count(), kUnknown) {}

std::optional<Cell> Cells::of(ShellIndex shell) {
  const ShellNodes& nodes = model_.shell(shell);
  if (!nodes.is_triangle()) return Cell{{nodes.node[0], nodes.node[1], nodes.node[2], nodes.node[3]}, shell, shell};
  const ShellIndex partner = partner_of(shell);
  if (!partner.valid()) return std::nullopt;
  return Cell{quad_of(shell, partner), shell, partner};
}

ShellIndex Cells::only_neighbour(ShellIndex shell, Edge edge) const {
  if (edge.low == edge.high) return {};
  return only_neighbour(shell, model_.adjacency->find_edge(edge.low, edge.high));
}

ShellIndex Cells::only_neighbour(ShellIndex shell, EdgeIndex edge) const {
  ShellIndex found;
  for (const ShellIndex other : model_.adjacency->shells_of(edge)) {
    if (other == shell || !in_sight(model_, other, out_of_sight_)) continue;
    if (found.valid()) return {};
    found = other;
  }
  return found;
}

/// The one of a cell's shells that has the edge.
ShellIndex Cells::shell_at(const Cell& cell, Edge edge) const {
  if (cell.one == cell.other) return cell.one;
  const ShellNodes& nodes = model_.shell(cell.one);
  return has_node(nodes, edge.low) && has_node(nodes, edge.high) ? cell.one : cell.other;
}

ShellIndex Cells::beyond(const Cell& cell, std::size_t position) const {
  const Edge edge = cell.edge(position);
  return only_neighbour(shell_at(cell, edge), edge);
}

Walk Cells::walk(Cell cell, std::size_t position, std::size_t max_edges) {
  Walk walk;
  Vec3 normal = normal_of(model_, cell);
  while (walk.count < max_edges) {
    const ShellIndex next = beyond(cell, position);
    if (!next.valid()) break;
    const std::optional<Cell> other = of(next);
    const Edge edge = cell.edge(position);
    const NodeIndex to = cell.node[(position + 1) % 4];
    walk.edges[walk.count++] = crossing(edge, centre_of(model_, cell), other ? centre_of(model_, *other) : centre_of(model_, next), normal);
    if (!other) break;
    const std::size_t there = other->position_of(edge);
    if (there == 4) break;
    // neighbours run along their common edge in opposite directions if their normals agree
    const bool agrees = other->node[there] == to;
    const bool turned = normal_of(model_, cell).dot(normal) < 0;
    normal = normal_of(model_, *other) * (agrees != turned ? 1.0 : -1.0);
    cell = *other;
    position = (there + 2) % 4;
  }
  walk.at_end = walk.count < max_edges;
  return walk;
}

namespace {

/// From the middle of an edge into the cells on its sides, at right angles to it.
struct Sides {
  Vec3 from, into;
};
Sides sides_at(const Model& model, Edge edge, const Vec3& from, const Vec3& into) {
  const Vec3& a = model.position(edge.low);
  const Vec3 along = model.position(edge.high) - a, middle = 0.5 * (a + model.position(edge.high));
  const double length2 = along.squaredNorm();
  const auto away = [&](const Vec3& centre) {
    const Vec3 out = centre - middle;
    return length2 > 0 ? Vec3(out - along * (out.dot(along) / length2)) : out;
  };
  return {away(from), away(into)};
}

}  // namespace

Walk::Crossing Cells::crossing(Edge edge, const Vec3& from, const Vec3& into, const Vec3& normal) const {
  const Sides sides = sides_at(model_, edge, from, into);
  double degrees = deterministic_atan2(sides.from.cross(sides.into).norm(), -sides.from.dot(sides.into)) * kDegreesPerRadian;
  if (sides.into.dot(normal) < 0) degrees = -degrees;
  const double width = 2 * std::min(sides.from.norm(), sides.into.norm());
  return {degrees, width > 0 ? degrees / width : 0};
}

bool Cells::is_flat_at(const Cell& cell, std::size_t position, double radians) {
  const Edge edge = cell.edge(position);
  if (edge.low == edge.high) return true;
  const EdgeIndex index = model_.adjacency->find_edge(edge.low, edge.high);
  // Both sides of an edge ask, and bend by the same angle.
  std::uint8_t& known = flat_[index.value];
  if (known == kUnknown) known = bends_little(cell, edge, index, radians) ? kFlat : kBends;
  return known == kFlat;
}

bool Cells::bends_little(const Cell& cell, Edge edge, EdgeIndex index, double radians) {
  const ShellIndex next = only_neighbour(shell_at(cell, edge), index);
  if (!next.valid()) return true;
  const std::optional<Cell> other = of(next);
  const Sides sides = sides_at(model_, edge, centre_of(model_, cell), other ? centre_of(model_, *other) : centre_of(model_, next));
  const double straight = -sides.from.dot(sides.into);
  // The tangent of so small an angle is the angle.
  return straight > 0 && sides.from.cross(sides.into).squaredNorm() <= radians * radians * straight * straight;
}

/// The quad of two triangles that share an edge, in the first one's direction.
std::array<NodeIndex, 4> Cells::quad_of(ShellIndex shell, ShellIndex partner) const {
  const ShellNodes& nodes = model_.shell(shell);
  const ShellNodes& others = model_.shell(partner);
  NodeIndex far;
  std::size_t apex = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!has_node(nodes, others.node[i])) far = others.node[i];
    if (!has_node(others, nodes.node[i])) apex = i;
  }
  return {nodes.node[apex], nodes.node[(apex + 1) % 3], far, nodes.node[(apex + 2) % 3]};
}

/// The neighbour with which a triangle makes the best quad.
ShellIndex Cells::best_partner(ShellIndex shell) const {
  const ShellNodes& nodes = model_.shell(shell);
  ShellIndex best;
  double best_shape = kMinShape;
  Edge best_edge;
  for (std::size_t i = 0; i < 3; ++i) {
    const NodeIndex a = nodes.node[i], b = nodes.node[(i + 1) % 3];
    const Edge edge = a < b ? Edge{a, b} : Edge{b, a};
    const ShellIndex other = only_neighbour(shell, edge);
    if (!other.valid() || !model_.shell(other).is_triangle()) continue;
    const double shape = shape_of(model_, quad_of(shell, other));
    // Of equally good ones both triangles take the edge with the lower nodes.
    const bool is_equal = std::abs(shape - best_shape) <= kEqual * best_shape && best.valid();
    const bool is_lower = edge.low < best_edge.low || (edge.low == best_edge.low && edge.high < best_edge.high);
    if (is_equal ? !is_lower : shape <= best_shape) continue;
    best = other;
    best_shape = shape;
    best_edge = edge;
  }
  return best;
}

ShellIndex Cells::partner_of(ShellIndex shell) {
  std::uint32_t& known = partner_[shell.value];
  if (known == kNotAsked) {
    const ShellIndex best = best_partner(shell);
    known = best.valid() && best_partner(best) == shell ? best.value : kNone;
  }
  return known == kNone ? ShellIndex() : ShellIndex(known);
}

}  // namespace prismesh::mesh::select
