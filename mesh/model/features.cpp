#include "mesh/model/features.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"
#include "base/parallel_for.h"

namespace prismesh::mesh {

namespace {

/// The direction from an edge into a shell, at right angles to the edge. It depends on the shell's place, not on the order of its nodes:
/// two shells of a plane sheet have opposite directions, however their normals are oriented.
Vec3 away_from_edge(const Model& model, ShellIndex shell, const Vec3& middle, const Vec3& along) {
  const ShellNodes& nodes = model.shell(shell);
  Vec3 centre = Vec3::Zero();
  for (int i = 0; i < nodes.corners(); ++i) centre += model.position(nodes.node[i]);
  const Vec3 out = centre / nodes.corners() - middle;
  const double length2 = along.squaredNorm();
  return length2 > 0 ? Vec3(out - along * (out.dot(along) / length2)) : out;
}

EdgeKind classify(const Model& model, EdgeIndex edge, Edge ends, double cos_limit) {
  const auto shells = model.adjacency->shells_of(edge);
  if (shells.size() == 1) return EdgeKind::free;
  if (shells.size() > 2) return EdgeKind::junction;
  return is_crease(model, shells[0], shells[1], ends, cos_limit) ? EdgeKind::crease : EdgeKind::smooth;
}

}  // namespace

bool is_crease(const Model& model, ShellIndex first, ShellIndex second, Edge ends, double cos_limit) {
  const Vec3& a = model.position(ends.low);
  const Vec3& b = model.position(ends.high);
  const Vec3 middle = 0.5 * (a + b);
  const Vec3 along = b - a;
  const Vec3 one = away_from_edge(model, first, middle, along);
  const Vec3 other = away_from_edge(model, second, middle, along);
  // a shell without width has no plane
  const double size = std::sqrt(one.squaredNorm() * other.squaredNorm());
  return size > 1e-12 * along.squaredNorm() && -one.dot(other) < cos_limit * size;
}

Bend bend_between(const Model& model, ShellIndex first, ShellIndex second, Edge ends) {
  const Vec3& a = model.position(ends.low);
  const Vec3& b = model.position(ends.high);
  const Vec3 middle = 0.5 * (a + b);
  const Vec3 one = away_from_edge(model, first, middle, b - a);
  const Vec3 other = away_from_edge(model, second, middle, b - a);
  return {kDegreesPerRadian * deterministic_atan2(one.cross(other).norm(), -one.dot(other)), 2 * std::min(one.norm(), other.norm()), other};
}

EdgeKind classify_edge(const Model& model, EdgeIndex edge, Edge ends, double angle_degrees) {
  return classify(model, edge, ends, deterministic_cos_degrees(angle_degrees));
}

std::vector<EdgeKind> classify_edges(const Model& model, double angle_degrees) {
  const Adjacency& adjacency = *model.adjacency;
  const double cos_limit = deterministic_cos_degrees(angle_degrees);
  std::vector<EdgeKind> kinds(adjacency.edge_count());
  parallel_for(model.node_count(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t low = begin; low < end; ++low)
      for (std::size_t e = adjacency.edge_first[low]; e < adjacency.edge_first[low + 1]; ++e)
        kinds[e] = classify(model, EdgeIndex(e), {NodeIndex(low), adjacency.edge_high[e]}, cos_limit);
  });
  return kinds;
}

}  // namespace prismesh::mesh
