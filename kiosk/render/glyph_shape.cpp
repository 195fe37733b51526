#include "kiosk/render/glyph_shape.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "mesh/quality/metrics.h"

namespace prismesh::kiosk::render {

using mesh::Vec3;
using mesh::quality::Metric;
using mesh::quality::ShellState;

namespace {

constexpr std::uint16_t bits(std::initializer_list<Metric> metrics) {
  unsigned all = 0;
  for (const Metric metric : metrics) all |= 1U << static_cast<unsigned>(metric);
  return static_cast<std::uint16_t>(all);
}

struct ShapeMetrics {
  GlyphShape shape;
  std::uint16_t metrics;
};
constexpr std::array<ShapeMetrics, kMaxShapesOfShell> kShapes{
    {{GlyphShape::warped, bits({Metric::warpage})},
     {GlyphShape::short_edge, bits({Metric::min_length})},
     {GlyphShape::long_edge, bits({Metric::max_length})},
     {GlyphShape::small_angle, bits({Metric::min_angle_quad, Metric::min_angle_tri})},
     {GlyphShape::large_angle, bits({Metric::max_angle_quad, Metric::max_angle_tri})},
     {GlyphShape::stretched, bits({Metric::aspect})}}};
constexpr std::uint16_t kAllMetrics = (1U << mesh::quality::kMetricCount) - 1;

/// Angle between the normals of the triangles on either side of the diagonal from corner k to corner k + 2.
double bend_about(std::span<const Vec3> p, std::size_t k) {
  const Vec3 along = p[k + 2] - p[k];
  const Vec3 one = (p[k + 1] - p[k]).cross(along), other = along.cross(p[(k + 3) % 4] - p[k]);
  return std::atan2(one.cross(other).norm(), one.dot(other));
}

/// Interior angle at a corner, radians; above pi at a reflex corner.
double angle_at(std::span<const Vec3> p, std::size_t k, const Vec3& normal) {
  const Vec3 next = p[(k + 1) % p.size()] - p[k], before = p[(k + p.size() - 1) % p.size()] - p[k];
  const Vec3 across = next.cross(before);
  const double angle = std::atan2(across.norm(), next.dot(before));
  return p.size() == 4 && across.dot(normal) < 0 ? 2 * 3.14159265358979 - angle : angle;
}

/// The k in [0, count) with the max value; the first of equal ones.
template <class Value>
unsigned index_of_max(std::size_t count, const Value& value) {
  unsigned best = 0;
  double max = value(0);
  for (std::size_t k = 1; k < count; ++k)
    if (const double here = value(k); here > max) {
      max = here;
      best = static_cast<unsigned>(k);
    }
  return best;
}

}  // namespace

std::vector<GlyphShape> shapes_of(const ShellState& state) {
  if (state.has_defect()) return {GlyphShape::defect};
  const auto wrong = static_cast<std::uint16_t>((state.fail != 0 ? state.fail : state.warn) & kAllMetrics);
  std::vector<GlyphShape> shapes;
  for (const ShapeMetrics& candidate : kShapes)
    if ((wrong & candidate.metrics) != 0) shapes.push_back(candidate.shape);
  if (shapes.empty() && wrong != 0) shapes.push_back(GlyphShape::other);
  return shapes;
}

unsigned glyph_place(GlyphShape shape, std::span<const Vec3> p) {
  const std::size_t count = p.size();
  for (const Vec3& corner : p)
    if (!corner.allFinite()) return 0;
  const auto edge = [&](std::size_t k) { return (p[(k + 1) % count] - p[k]).norm(); };
  const Vec3 normal = count == 4 ? Vec3((p[2] - p[0]).cross(p[3] - p[1])) : Vec3((p[1] - p[0]).cross(p[2] - p[0]));
  switch (shape) {
    case GlyphShape::warped: return count == 4 && bend_about(p, 1) > bend_about(p, 0) ? 1 : 0;
    case GlyphShape::short_edge:
      // A triangle's smallest height falls on its longest edge.
      return count == 3 ? (index_of_max(count, edge) + 2) % 3 : index_of_max(count, [&](std::size_t k) { return -edge(k); });
    case GlyphShape::long_edge:
    case GlyphShape::stretched: return index_of_max(count, edge);
    case GlyphShape::small_angle: return index_of_max(count, [&](std::size_t k) { return -angle_at(p, k, normal); });
    case GlyphShape::large_angle: return index_of_max(count, [&](std::size_t k) { return angle_at(p, k, normal); });
    case GlyphShape::cluster:
    case GlyphShape::defect:
    case GlyphShape::other: break;
  }
  return 0;
}

}  // namespace prismesh::kiosk::render
