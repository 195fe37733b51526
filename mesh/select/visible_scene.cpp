#include "mesh/select/visible_scene.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "base/parallel_for.h"
#include "mesh/spatial/distance.h"

namespace prismesh::mesh::select {

namespace {

/// Planes that a node can be beyond. A shell with all corners beyond one of them hides nothing.
enum Beyond : std::uint8_t {
  kLeft = 1,
  kRight = 2,
  kBelow = 4,
  kAbove = 8,
  kBeforeNear = 16,
  kBehindAll = 32,
  kBehindEye = 64,
};

Seen divided(const ClipPoint& p) {
  const double scale = 1 / p.w;
  return {p.x * scale, p.y * scale, p.z * scale};
}

ClipPoint between(const ClipPoint& a, const ClipPoint& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z), a.w + share * (b.w - a.w)};
}

/// A convex polygon cut at a plane; a triangle that two planes cut has five corners.
struct Polygon {
  std::array<ClipPoint, 5> corner;
  std::size_t count = 0;
};

/// Clips a polygon to where `height` isn't negative [Sutherland 1974].
template <class Height>
Polygon cut(const Polygon& polygon, Height&& height) {
  Polygon rest;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const ClipPoint& a = polygon.corner[i];
    const ClipPoint& b = polygon.corner[i + 1 == polygon.count ? 0 : i + 1];
    const double at_a = height(a), at_b = height(b);
    if (at_a >= 0) rest.corner[rest.count++] = a;
    if ((at_a >= 0) != (at_b >= 0) && rest.count < rest.corner.size()) rest.corner[rest.count++] = between(a, b, at_a / (at_a - at_b));
  }
  return rest;
}

/// Twice the signed area of a, b, p. Exchanging a and b changes the sign only: so a point near the side that two triangles share lies in
/// one of them.
double side_of(const Seen& a, const Seen& b, const Seen& p) {
  const bool ordered = a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  const Seen& first = ordered ? a : b;
  const Seen& last = ordered ? b : a;
  const double area = (last.x() - first.x()) * (p.y() - first.y()) - (last.y() - first.y()) * (p.x() - first.x());
  return ordered ? area : -area;
}

/// Depth of a projected triangle at the place p; infinity outside it.
double depth_at(const Seen& corner_a, const Seen& corner_b, const Seen& corner_c, const Seen& p) {
  constexpr double kBeside = std::numeric_limits<double>::infinity();
  const double a = side_of(corner_b, corner_c, p), b = side_of(corner_c, corner_a, p), c = side_of(corner_a, corner_b, p);
  const bool inside = (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
  const double area = a + b + c;
  if (!inside || area == 0) return kBeside;  // seen edge-on it covers nothing
  return (a * corner_a.z() + b * corner_b.z() + c * corner_c.z()) / area;
}

}  // namespace

Scene::Scene(const Model& model, const ViewMatrix& view, const NodeSet& candidates, std::span<const std::uint8_t> out_of_sight)
    : model_(model), view_(view), out_of_sight_(out_of_sight) {
  find_nodes(candidates);
  if (nodes_.empty()) return;
  project();
  find_midside_owners();
}

void Scene::find_nodes(const NodeSet& candidates) {
  constexpr std::size_t kGrain = 16384;
  struct Piece {
    std::vector<SeenNode> nodes;
    Seen low = Seen::Constant(std::numeric_limits<double>::infinity());
    Seen high = -low;
  };
  std::vector<Piece> pieces((candidates.size() + kGrain - 1) / kGrain);
  parallel_for(candidates.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Piece& piece = pieces[begin / kGrain];
    piece.nodes.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const ClipPoint p = clip_point(view_, model_.position(candidates[i]));
      if (!(p.w > 0 && p.z >= -p.w && p.z <= p.w)) continue;
      const Seen at = divided(p);
      piece.nodes.push_back({at, candidates[i]});
      piece.low = piece.low.cwiseMin(at);
      piece.high = piece.high.cwiseMax(at);
    }
  });
  low_ = Piece().low;
  high_ = Piece().high;
  std::size_t total = 0;
  for (const Piece& piece : pieces) total += piece.nodes.size();
  reserve_large(nodes_, total);
  for (const Piece& piece : pieces) {
    nodes_.insert(nodes_.end(), piece.nodes.begin(), piece.nodes.end());
    low_ = low_.cwiseMin(piece.low);
    high_ = high_.cwiseMax(piece.high);
  }
}

void Scene::project() {
  // slightly larger than the box of the nodes, for rounding
  const Seen slack = 1e-9 * (high_ - low_) + Seen::Constant(1e-12);
  const Seen low = low_ - slack, high = high_ + slack;
  seen_bytes_ = LargeBlock(model_.node_count() * sizeof(Seen));
  seen_ = {reinterpret_cast<Seen*>(seen_bytes_.data()), model_.node_count()};
  beyond_.resize(model_.node_count());
  parallel_for(model_.positions.chunk_count(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const auto positions = model_.positions.chunk(c);
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const ClipPoint p = clip_point(view_, positions[i]);
        const auto bit = [](bool is, Beyond plane) { return is ? static_cast<int>(plane) : 0; };
        beyond_[c * kChunkSize + i] =
            static_cast<std::uint8_t>(bit(p.x < low.x() * p.w, kLeft) | bit(p.x > high.x() * p.w, kRight) |
                                      bit(p.y < low.y() * p.w, kBelow) | bit(p.y > high.y() * p.w, kAbove) | bit(p.z < -p.w, kBeforeNear) |
                                      bit(p.z > high.z() * p.w, kBehindAll) | bit(!(p.w > 0), kBehindEye));
        seen_[c * kChunkSize + i] = divided(p);
      }
    }
  });
}

void Scene::find_midside_owners() {
  for (const MidsideNodes& midside : *model_.midside)
    for (const NodeIndex node : midside.node)
      if (node.valid()) midside_owners_.emplace_back(node, midside.shell);
  std::sort(midside_owners_.begin(), midside_owners_.end());
}

SeenShell Scene::seen(ShellIndex index) const {
  const ShellNodes& corners = model_.shell(index);
  SeenShell shell;
  shell.shell = index;
  shell.corner = corners.node;
  int cut_by = 0;
  for (const NodeIndex node : corners.node) cut_by |= beyond_[node.value] & (kBeforeNear | kBehindEye);
  std::size_t points = 4;
  if (cut_by == 0) {
    for (std::size_t k = 0; k < 4; ++k) shell.point[k] = seen_[corners.node[k].value];
    shell.triangle[0] = {0, 1, 2};
    shell.triangle[1] = {0, 2, 3};
    shell.triangles = corners.is_triangle() ? 1 : 2;
  } else {
    points = cut_at_near_plane(shell);
  }
  shell.low = Seen::Constant(std::numeric_limits<double>::infinity());
  shell.high = -shell.low;
  for (std::size_t k = 0; k < points; ++k) {
    shell.low = shell.low.cwiseMin(shell.point[k]);
    shell.high = shell.high.cwiseMax(shell.point[k]);
  }
  return shell;
}

std::size_t Scene::cut_at_near_plane(SeenShell& shell) const {
  shell.is_cut = true;
  std::size_t points = 0;
  for (const std::size_t last : {std::size_t{2}, std::size_t{3}}) {
    if (shell.corner[last] == shell.corner[last - 1]) continue;  // a triangle has no second half
    Polygon polygon;
    double size = 0;
    for (const std::size_t k : {std::size_t{0}, last - 1, last}) {
      polygon.corner[polygon.count++] = clip_point(view_, model_.position(shell.corner[k]));
      size = std::max(size, std::abs(polygon.corner[polygon.count - 1].w));
    }
    polygon = cut(polygon, [](const ClipPoint& p) { return p.z + p.w; });
    polygon = cut(polygon, [&](const ClipPoint& p) { return p.w - 1e-12 * size; });
    for (std::size_t k = 2; k < polygon.count; ++k)
      shell.triangle[shell.triangles++] = {static_cast<std::uint8_t>(points), static_cast<std::uint8_t>(points + k - 1),
                                           static_cast<std::uint8_t>(points + k)};
    for (std::size_t k = 0; k < polygon.count; ++k) shell.point[points++] = divided(polygon.corner[k]);
  }
  return points;
}

bool Scene::hides(const SeenShell& shell, const SeenNode& node) const {
  if (shell.is_own(node.node)) return false;
  for (std::size_t t = 0; t < shell.triangles; ++t) {
    const auto& of = shell.triangle[t];
    if (depth_at(shell.point[of[0]], shell.point[of[1]], shell.point[of[2]], node.at) < node.at.z())
      return !is_midside_of(node.node, shell.shell) && !lies_on(node.node, shell);
  }
  return false;
}

bool Scene::is_midside_of(NodeIndex node, ShellIndex shell) const {
  return std::binary_search(midside_owners_.begin(), midside_owners_.end(), std::pair(node, shell));
}

bool Scene::lies_on(NodeIndex node, const SeenShell& shell) const {
  const Vec3& point = model_.position(node);
  std::array<Vec3, 4> at;
  for (std::size_t i = 0; i < 4; ++i) at[i] = model_.position(shell.corner[i]);
  double max_edge2 = 0;
  for (std::size_t i = 0; i < 4; ++i) max_edge2 = std::max(max_edge2, (at[(i + 1) % 4] - at[i]).squaredNorm());
  const double near2 = kLiesOnShell * kLiesOnShell * max_edge2;
  for (const std::size_t third : {std::size_t{2}, std::size_t{3}}) {
    const Vec3 normal = (at[third - 1] - at[0]).cross(at[third] - at[0]);
    const double height = normal.dot(point - at[0]);
    if (height * height > near2 * normal.squaredNorm()) continue;  // not in its plane: the usual case
    if (spatial::nearest_of_triangles({point, point, point}, {at[0], at[third - 1], at[third]}).distance2 <= near2) return true;
  }
  return false;
}

}  // namespace prismesh::mesh::select
