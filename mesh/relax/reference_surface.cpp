#include "mesh/relax/reference_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "mesh/relax/feature_lines.h"
#include "mesh/relax/line_cache.h"
#include "mesh/relax/line_curve.h"
#include "mesh/relax/sheet_fits.h"
#include "mesh/spatial/closest_point.h"

namespace prismesh::mesh::relax {

namespace {

constexpr double kMaxLean = 60;             ///< degrees
constexpr double kNearFoot = 1e-3;          ///< of the size: tolerance for the foot of the perpendicular
constexpr int kMaxFeet = 6;                 ///< iterations for the foot
constexpr int kMaxSteps = 256;              ///< of a descent over shells
constexpr double kMaxDistanceShare = 0.25;  ///< of a shell's longest diagonal: a fitted point farther from the facet is rejected

/// A point in a shell by its corners' shares, which sum to 1.
struct OnFacet {
  std::array<double, 4> share{};
  Vec3 point = Vec3::Zero();
  double distance2 = 0;
};

OnFacet at_shares(const std::array<Vec3, 4>& p, const std::array<double, 4>& share, const Vec3& point) {
  OnFacet on{share, share[0] * p[0] + share[1] * p[1] + share[2] * p[2] + share[3] * p[3], 0};
  on.distance2 = (on.point - point).squaredNorm();
  return on;
}

OnFacet on_side(const std::array<Vec3, 4>& p, int i, int j, const Vec3& point) {
  const Vec3 along = p[j] - p[i];
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((point - p[i]).dot(along) / length2, 0.0, 1.0) : 0.0;
  std::array<double, 4> share{};
  share[i] += 1 - t;
  share[j] += t;
  return at_shares(p, share, point);
}

OnFacet on_triangle(const std::array<Vec3, 4>& p, int i, int j, int k, const Vec3& point) {
  const Vec3 b = p[j] - p[i], c = p[k] - p[i], d = point - p[i];
  const Vec3 normal = b.cross(c);
  const double area2 = normal.squaredNorm();
  const double t = d.cross(c).dot(normal) / area2, s = b.cross(d).dot(normal) / area2;
  if (area2 > 1e-16 * b.squaredNorm() * c.squaredNorm() && t >= 0 && s >= 0 && t + s <= 1) {
    std::array<double, 4> share{};
    share[i] = 1 - t - s;
    share[j] = t;
    share[k] = s;
    return at_shares(p, share, point);
  }
  OnFacet best = on_side(p, i, j, point);
  for (const OnFacet& other : {on_side(p, j, k, point), on_side(p, k, i, point)})
    if (other.distance2 < best.distance2) best = other;
  return best;
}

/// The nearest point of a quad's bilinear patch: a few Gauss-Newton steps from the nearest point of its two halves.
OnFacet on_quad(const std::array<Vec3, 4>& p, const Vec3& point) {
  const OnFacet first = on_triangle(p, 0, 1, 2, point), second = on_triangle(p, 0, 2, 3, point);
  const OnFacet& half = first.distance2 <= second.distance2 ? first : second;
  double s = half.share[1] + half.share[2], t = half.share[2] + half.share[3];
  const auto bilinear = [&] { return at_shares(p, {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t}, point); };
  OnFacet best = bilinear();
  for (int i = 0; i < 3 && best.distance2 > 0; ++i) {
    const Vec3 by_s = (1 - t) * (p[1] - p[0]) + t * (p[2] - p[3]);
    const Vec3 by_t = (1 - s) * (p[3] - p[0]) + s * (p[2] - p[1]);
    const Vec3 off = point - best.point;
    const double ss = by_s.squaredNorm(), tt = by_t.squaredNorm(), st = by_s.dot(by_t);
    const double determinant = ss * tt - st * st;
    if (!(determinant > 1e-12 * ss * tt)) break;
    const double a = by_s.dot(off), b = by_t.dot(off);
    s = std::clamp(s + (tt * a - st * b) / determinant, 0.0, 1.0);
    t = std::clamp(t + (ss * b - st * a) / determinant, 0.0, 1.0);
    const OnFacet better = bilinear();
    const bool done = (better.point - best.point).squaredNorm() <= 1e-16 * (ss + tt);
    if (better.distance2 < best.distance2) best = better;
    if (done) break;
  }
  return best;
}

OnFacet on_facet(const Model& model, const ShellNodes& shell, const Vec3& point) {
  std::array<Vec3, 4> p;
  for (int i = 0; i < 4; ++i) p[i] = model.position(shell.node[i]);
  return shell.is_triangle() ? on_triangle(p, 0, 1, 2, point) : on_quad(p, point);
}

OnLine on_line(const Model& model, const CurvePoint& place) {
  const auto [from, to] = place.piece;
  const double before = (place.point - model.position(from)).norm(), after = (place.point - model.position(to)).norm();
  const double share = before + after > 0 ? before / (before + after) : 0;
  return {from, to, place.point, place.tangent, place.distance, (1 - share) * mean_edge(model, from) + share * mean_edge(model, to)};
}

double longest_diagonal(const Model& model, const ShellNodes& shell) {
  const auto length = [&](int i, int j) { return (model.position(shell.node[i]) - model.position(shell.node[j])).norm(); };
  return std::max(length(0, 2), shell.is_triangle() ? std::max(length(0, 1), length(1, 2)) : length(1, 3));
}

}  // namespace

struct ReferenceSurface::Impl {
  Impl(const Model& of, const ShellSet& set, double feature_angle)
      : model(of), shells(set), cos_limit(deterministic_cos_degrees(feature_angle)), sheets(model, cos_limit), lines(model, cos_limit) {}

  const spatial::ShellTree& tree() {
    std::call_once(tree_made, [this] { made_tree = std::make_unique<const spatial::ShellTree>(model, shells); });
    return *made_tree;
  }
  /// Descends from `from` over smooth edges to the shell nearest to the point. Returns it with the nearest point on its facet.
  std::pair<ShellIndex, OnFacet> walk(ShellIndex from, const Vec3& point) const;
  /// The corners' fits over a point on a shell, averaged by the corners' shares. Source: Jiao and Wang, weighted averaging [Jiao 2012].
  OnSurface blend(ShellIndex shell, const OnFacet& facet) const;

  Model model;
  ShellSet shells;
  double cos_limit;
  SheetFits sheets;
  LineCache lines;
  std::once_flag tree_made;
  std::unique_ptr<const spatial::ShellTree> made_tree;
};

std::pair<ShellIndex, OnFacet> ReferenceSurface::Impl::walk(ShellIndex from, const Vec3& point) const {
  ShellIndex at = from;
  OnFacet best = on_facet(model, model.shell(at), point);
  for (int step = 0; step < kMaxSteps && best.distance2 > 0; ++step) {
    const ShellNodes& nodes = model.shell(at);
    const int corners = nodes.corners();
    ShellIndex better;
    const auto look = [&](ShellIndex next) {
      if (!next.valid() || next == at) return;
      const OnFacet on = on_facet(model, model.shell(next), point);
      if (!(on.distance2 < best.distance2)) return;
      best = on;
      better = next;
    };
    const std::array<double, 4> share = best.share;
    for (int i = 0; i < corners; ++i) {
      // the point lies on this side
      if (share[i] + share[next_corner(i, corners)] >= 1 - 1e-12)
        look(sheets.smooth_neighbour(at, nodes.node[i], nodes.node[next_corner(i, corners)]));
      if (share[i] >= 1 - 1e-12 && sheets.is_smooth(nodes.node[i]))
        for (const ShellIndex next : model.adjacency->shells_of(nodes.node[i])) look(next);
    }
    if (!better.valid()) break;
    at = better;
  }
  return {at, best};
}

OnSurface ReferenceSurface::Impl::blend(ShellIndex shell, const OnFacet& facet) const {
  const ShellNodes& nodes = model.shell(shell);
  OnSurface on;
  on.shell = shell;
  const Vec3 side = shell_normal(model, nodes);
  for (int i = 0; i < nodes.corners(); ++i) {
    if (facet.share[i] == 0) continue;
    const LocalFit& fit = sheets.at(shell, i);
    const LocalFit::FitPoint place = fit.point_over(facet.point);
    on.size += facet.share[i] * fit.edge;
    on.point += facet.share[i] * place.point;
    on.normal += facet.share[i] * (place.normal.dot(side) < 0 ? -1.0 : 1.0) / place.normal.norm() * place.normal;
  }
  const double farthest = kMaxDistanceShare * longest_diagonal(model, nodes);
  if (!((on.point - facet.point).squaredNorm() <= farthest * farthest)) on.point = facet.point;
  on.normal = on.normal.squaredNorm() > 0 ? Vec3(on.normal.normalized()) : side;
  return on;
}

ReferenceSurface::ReferenceSurface(const Model& model, const ShellSet& shells, double feature_angle)
    : impl_(std::make_unique<Impl>(model, shells, feature_angle)) {}
ReferenceSurface::~ReferenceSurface() = default;
ReferenceSurface::ReferenceSurface(ReferenceSurface&&) noexcept = default;
ReferenceSurface& ReferenceSurface::operator=(ReferenceSurface&&) noexcept = default;

const Model& ReferenceSurface::model() const { return impl_->model; }

OnSurface ReferenceSurface::follow(ShellIndex from, const Vec3& point) const {
  auto [shell, facet] = impl_->walk(from, point);
  OnSurface on = impl_->blend(shell, facet);
  on.distance = (point - on.point).norm();
  // The foot on the facets isn't quite the foot on the surface: move it along the facets by the tangential rest, and repeat.
  for (int i = 1; i < kMaxFeet; ++i) {
    const Vec3 off = point - on.point, beside = off - on.normal * off.dot(on.normal);
    if (!(beside.squaredNorm() > kNearFoot * kNearFoot * on.size * on.size)) break;
    const auto [next_shell, next_facet] = impl_->walk(shell, facet.point + beside);
    OnSurface next = impl_->blend(next_shell, next_facet);
    next.distance = (point - next.point).norm();
    if (!(next.distance < on.distance)) break;
    on = next;
    shell = next_shell;
    facet = next_facet;
  }
  return on;
}

OnLine ReferenceSurface::follow_line(NodeIndex from, NodeIndex to, const Vec3& point) const {
  return on_line(impl_->model, relax::follow_line(impl_->lines, {from, to}, point));
}

std::optional<OnSurface> ReferenceSurface::project(const Vec3& point, double radius, const std::optional<Vec3>& toward) const {
  const double min_cos = deterministic_cos_degrees(kMaxLean);
  const auto leans = [&](ShellIndex shell) {
    return toward && std::abs(shell_normal(impl_->model, impl_->model.shell(shell)).dot(*toward)) < min_cos * toward->norm();
  };
  std::optional<spatial::SurfacePoint> best = impl_->tree().closest(point, radius);
  if (best && leans(best->shell)) {
    best.reset();
    for (const spatial::SurfacePoint& near : impl_->tree().within(point, radius))
      if (!leans(near.shell) && (!best || near.distance < best->distance)) best = near;
  }
  if (!best) return std::nullopt;
  const OnSurface on = follow(best->shell, point);
  return on.distance <= radius ? std::optional(on) : std::nullopt;
}

std::optional<OnLine> ReferenceSurface::find_line(const Vec3& point, double radius) const {
  const Model& model = impl_->model;
  std::optional<CurvePoint> best;
  for (const spatial::SurfacePoint& near : impl_->tree().within(point, radius)) {
    const ShellNodes& nodes = model.shell(near.shell);
    const int corners = nodes.corners();
    for (int i = 0; i < corners; ++i) {
      const NodeIndex a = std::min(nodes.node[i], nodes.node[next_corner(i, corners)]),
                      b = std::max(nodes.node[i], nodes.node[next_corner(i, corners)]);
      if (a == b || !impl_->lines.is_feature(near.shell, a, b)) continue;
      const CurvePoint place = closest_on_piece(impl_->lines, {a, b}, point);
      if (!best || place.distance < best->distance) best = place;
    }
  }
  if (!best || !(best->distance <= radius)) return std::nullopt;
  return on_line(model, *best);
}

std::vector<NodeIndex> ReferenceSurface::lines_at(NodeIndex node) const {
  const LineEnds& ends = impl_->lines.at(node).ends;
  return {ends.other.begin(), ends.other.begin() + static_cast<std::ptrdiff_t>(ends.count)};
}

Freedom ReferenceSurface::freedom_at(NodeIndex node) const {
  const Model& model = impl_->model;
  const auto shells = model.adjacency->shells_of(node);
  const bool one_part = std::all_of(shells.begin(), shells.end(), [&](ShellIndex shell) {
    return model.shell_parts[shell.value] == model.shell_parts[shells.front().value];
  });
  if (one_part && !shells.empty() && impl_->sheets.is_smooth(node)) return Freedom::surface;
  return freedom_of(model, node, impl_->cos_limit);
}

std::optional<Vec3> ReferenceSurface::project_on_line(const Vec3& point, double radius) const {
  const std::optional<OnLine> line = find_line(point, radius);
  return line ? std::optional(line->point) : std::nullopt;
}

}  // namespace prismesh::mesh::relax
