#include "mesh/contact/close_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <Eigen/Geometry>

#include "mesh/contact/orientation.h"
#include "mesh/contact/sheet_path.h"
#include "mesh/contact/shell_triangles.h"
#include "mesh/model/adjacency.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::contact {

namespace {

OwnTriangles triangles_from(const Model& model, ShellIndex shell, const Vec3& origin) {
  OwnTriangles found;
  each_shell_triangle(model, shell, [&](const ShellTriangle& t) {
    if (on_a_line(t.at[0], t.at[1], t.at[2])) return;
    found.normal[found.count] = (t.at[1] - t.at[0]).cross(t.at[2] - t.at[0]).normalized();
    found.at[found.count++] = {t.at[0] - origin, t.at[1] - origin, t.at[2] - origin};
  });
  return found;
}

/// The range of the triangles' corners in a direction.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};
Extent extent_of(const OwnTriangles& triangles, const Vec3& direction) {
  Extent extent;
  for (std::size_t i = 0; i < triangles.count; ++i)
    for (const Vec3& corner : triangles.at[i]) {
      const double along = corner.dot(direction);
      extent.low = std::min(extent.low, along), extent.high = std::max(extent.high, along);
    }
  return extent;
}

bool alike(const Vec3& normal, const Vec3& other) { return std::abs(normal.dot(other)) >= kMaxCosOfStanding; }

/// A bound below the distance, by the direction between the corners first and third.
double below_distance(const OwnTriangles& a, const OwnTriangles& b) {
  const Vec3 between = b.at[0][0] + b.at[0][2] - a.at[0][0] - a.at[0][2];
  const double length = between.norm();
  if (!(length > 0)) return 0;
  const Vec3 direction = between / length;
  return (1 - 1e-9) * (extent_of(b, direction).low - extent_of(a, direction).high);
}

/// Whether no point of one can face the other, whichever are nearest: they lie beside each other. `apart`: at least this far.
bool surely_beside(const OwnTriangles& a, const OwnTriangles& b, double apart) {
  for (std::size_t i = 0; i < a.count; ++i)
    for (std::size_t j = 0; j < b.count; ++j)
      if (!alike(a.normal[i], b.normal[j])) return false;
  const auto rises = [&](const Vec3& normal) {
    const Extent of_a = extent_of(a, normal), of_b = extent_of(b, normal);
    return std::max(of_b.high - of_a.low, of_a.high - of_b.low) >= (1 - 1e-9) * kMinCosOfFacing * apart;
  };
  for (std::size_t i = 0; i < a.count; ++i)
    if (rises(a.normal[i])) return false;
  for (std::size_t j = 0; j < b.count; ++j)
    if (rises(b.normal[j])) return false;
  return true;
}

struct NearestTriangles {
  spatial::Nearest points{std::numeric_limits<double>::infinity(), Vec3::Zero(), Vec3::Zero()};
  std::size_t of_a = 0, of_b = 0;
};

/// The nearest triangles of two shells; of equally near ones the first.
NearestTriangles nearest_of(const OwnTriangles& a, const OwnTriangles& b) {
  NearestTriangles best;
  for (std::size_t i = 0; i < a.count; ++i)
    for (std::size_t j = 0; j < b.count; ++j) {
      const spatial::Nearest points = spatial::nearest_of_triangles(a.at[i], b.at[j]);
      if (points.distance2 < best.points.distance2) best = {points, i, j};
    }
  return best;
}

double distance_from_segment(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (from + share * along - point).norm();
}

bool on_free_edge(const Model& model, ShellIndex shell, const Vec3& point, double tolerance) {
  const ShellNodes& nodes = model.shell(shell);
  const auto corners = static_cast<std::size_t>(nodes.corners());
  for (std::size_t i = 0; i < corners; ++i) {
    const NodeIndex from = nodes.node[i], to = nodes.node[(i + 1) % corners];
    const EdgeIndex edge = model.adjacency->find_edge(from, to);
    if (!edge.valid() || model.adjacency->shells_of(edge).size() != 1) continue;
    if (distance_from_segment(point, model.position(from), model.position(to)) <= tolerance) return true;
  }
  return false;
}

}  // namespace

std::optional<CloseShells> CloseTo::pair(ShellIndex other, double mean_thickness, double reach) {
  if (!own_) {
    origin_ = model_.position(model_.shell(shell_).node[0]);
    if (!can_decide(origin_)) origin_ = Vec3::Zero();
    own_ = triangles_from(model_, shell_, origin_);
  }
  const OwnTriangles its = triangles_from(model_, other, origin_);
  if (own_->count == 0 || its.count == 0) return std::nullopt;
  const double apart = below_distance(*own_, its);
  if (apart >= reach || (apart > kMinDepthShare * mean_thickness && surely_beside(*own_, its, apart))) return std::nullopt;
  const NearestTriangles nearest = nearest_of(*own_, its);
  const double distance = std::sqrt(nearest.points.distance2);
  if (!(distance < reach)) return std::nullopt;
  const Vec3 &normal = own_->normal[nearest.of_a], &its_normal = its.normal[nearest.of_b];
  CloseShells close{shell_,
                    other,
                    distance,
                    mean_thickness + gap_ - distance,
                    origin_ + nearest.points.on_a,
                    origin_ + nearest.points.on_b,
                    !alike(normal, its_normal),
                    false};
  const double touching = kMinDepthShare * mean_thickness;
  if (distance <= touching) {
    const bool at_edge = on_free_edge(model_, shell_, close.on_a, touching), at_its = on_free_edge(model_, other, close.on_b, touching);
    close.touch_at_edge = (at_edge && at_its) || (close.stand && (at_edge || at_its));
  } else if (!close.stand) {
    const Vec3 direction = (nearest.points.on_b - nearest.points.on_a) / distance;
    const auto faces = [&](const Vec3& with_normal) { return std::abs(with_normal.dot(direction)) >= kMinCosOfFacing; };
    if (!faces(normal) && !faces(its_normal)) return std::nullopt;
  }
  if (close.b < close.a) std::swap(close.a, close.b), std::swap(close.on_a, close.on_b);
  return close;
}

void CloseTo::leave_out_neighbours(std::vector<CloseShells>& found, std::size_t first) const {
  if (found.size() == first) return;
  const auto begin = found.begin() + static_cast<std::ptrdiff_t>(first);
  const auto other = [&](const CloseShells& close) { return close.a == shell_ ? close.b : close.a; };
  std::sort(begin, found.end(), [&](const CloseShells& x, const CloseShells& y) { return other(x) < other(y); });
  std::vector<PathWish> wishes;
  for (std::size_t i = first; i < found.size(); ++i)
    wishes.push_back({other(found[i]), kMinPathInLeastDistances * (found[i].distance + found[i].depth)});
  const std::vector<std::uint8_t> reached = reached_over_sheet(model_, shell_, wishes);
  std::size_t at = 0;
  found.erase(std::remove_if(begin, found.end(), [&](const CloseShells&) { return reached[at++] != 0; }), found.end());
}

}  // namespace prismesh::mesh::contact
