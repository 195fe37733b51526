#include "mesh/measure/lengths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "mesh/model/node_set.h"
#include "mesh/spatial/cut_patch.h"
#include "mesh/spatial/geodesic.h"

namespace prismesh::mesh::measure {

namespace {

constexpr double kDegrees = 57.295779513082320876798;
/// The first ball is this much larger than the straight distance: most ways on a sheet are hardly longer than that.
constexpr double kFirstDetour = 1.2;

/// The visible shells that have a corner within the radius of a point. `all`: whether none was left out for its distance.
ShellSet shells_within(const Model& model, const Vec3& centre, double radius, OutOfSight out_of_sight, bool& all) {
  ShellSet shells;
  all = true;
  for (std::size_t s = 0; s < model.shell_count(); ++s) {
    const ShellIndex shell(s);
    if (!in_sight(model, shell, out_of_sight)) continue;
    const ShellNodes& nodes = model.shell(shell);
    const auto is_near = [&](NodeIndex node) { return (model.position(node) - centre).norm() <= radius; };
    const auto is_finite = [&](NodeIndex node) { return model.position(node).allFinite(); };
    if (!std::all_of(nodes.node.begin(), nodes.node.end(), is_finite)) continue;
    if (std::any_of(nodes.node.begin(), nodes.node.end(), is_near))
      shells.push_back(shell);
    else
      all = false;
  }
  return shells;
}

std::optional<std::uint32_t> local_node(const spatial::Patch& patch, NodeIndex node) {
  const auto found = std::lower_bound(patch.nodes.begin(), patch.nodes.end(), node);
  if (found == patch.nodes.end() || *found != node) return std::nullopt;
  return static_cast<std::uint32_t>(found - patch.nodes.begin());
}

}  // namespace

std::optional<double> angle_degrees(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = (a - b).stableNormalized(), v = (c - b).stableNormalized();
  if (!(u.squaredNorm() > 0.5) || !(v.squaredNorm() > 0.5)) return std::nullopt;
  return std::atan2(u.cross(v).norm(), u.dot(v)) * kDegrees;
}

std::optional<Circle> circle_through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double size = std::max({(b - a).cwiseAbs().maxCoeff(), (c - a).cwiseAbs().maxCoeff(), (c - b).cwiseAbs().maxCoeff()});
  if (!(size > 0) || !std::isfinite(size)) return std::nullopt;
  const Vec3 u = (b - a) / size, v = (c - a) / size, w = (c - b) / size;
  const Vec3 cross = u.cross(v);
  const double longest2 = std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()});
  // Twice the triangle's area over its longest side is its smallest height.
  if (!(cross.norm() > 1e-9 * longest2)) return std::nullopt;
  const Vec3 to_centre = (u.squaredNorm() * v - v.squaredNorm() * u).cross(cross) * 0.5 / cross.squaredNorm();
  return Circle{a + size * to_centre, size * to_centre.norm(), cross.normalized()};
}

std::optional<double> length_along_surface(const Model& model, NodeIndex a, NodeIndex b, OutOfSight out_of_sight) {
  if (a == b) return 0.0;
  const Vec3 &from = model.position(a), &to = model.position(b);
  const double straight = (to - from).norm();
  if (!std::isfinite(straight)) return std::nullopt;
  // A way that is no longer than the ball's radius doesn't leave the ball. Nodes at one place: begin with a shell's size.
  double radius = straight * kFirstDetour;
  if (!(radius > 0)) radius = std::numeric_limits<double>::min();
  for (bool all = false; !all;) {
    const spatial::Patch patch = spatial::cut_patch(model, shells_within(model, from, radius, out_of_sight, all));
    const std::optional<std::uint32_t> start = local_node(patch, a), end = local_node(patch, b);
    if (!start && all) return std::nullopt;
    if (start && end) {
      const std::array<std::uint32_t, 1> sources{*start};
      const double length = spatial::geodesic_distance(patch, sources, all ? spatial::kUnreached : radius)[*end];
      if (std::isfinite(length)) return length;
    }
    if (!start) return std::nullopt;  // no visible shell has the node
    double reach = 0;
    for (const Vec3& position : patch.positions) reach = std::max(reach, (position - from).norm());
    radius = std::max(2 * radius, reach);
  }
  return std::nullopt;
}

NodeMeasures measure_nodes(const Model& model, std::span<const NodeIndex> nodes, OutOfSight out_of_sight) {
  const Vec3 &first = model.position(nodes.front()), &last = model.position(nodes.back());
  NodeMeasures measures;
  measures.between = last - first;
  measures.distance = measures.between.stableNorm();
  measures.along_surface = length_along_surface(model, nodes.front(), nodes.back(), out_of_sight);
  if (nodes.size() == 3) {
    measures.angle = angle_degrees(first, model.position(nodes[1]), last);
    measures.circle = circle_through(first, model.position(nodes[1]), last);
  }
  return measures;
}

}  // namespace prismesh::mesh::measure
