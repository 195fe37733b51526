#include "mesh/document/inverted_shells.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include "base/deterministic_math.h"

namespace prismesh::mesh::document {

namespace {

Vec3 normal_of(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  const auto at = [&](std::size_t i) { return model.position(nodes.node[i]); };
  return nodes.is_triangle() ? Vec3((at(1) - at(0)).cross(at(2) - at(0))) : Vec3((at(2) - at(0)).cross(at(3) - at(1)));
}

/// Whether the Jacobian is greater than 0 at every corner.
bool is_convex(const Model& model, ShellIndex shell, const Vec3& normal) {
  const ShellNodes& nodes = model.shell(shell);
  const int corners = nodes.corners();
  for (int i = 0; i < corners; ++i) {
    const Vec3& here = model.position(nodes.node[static_cast<std::size_t>(i)]);
    const Vec3 out = model.position(nodes.node[static_cast<std::size_t>((i + 1) % corners)]) - here;
    const Vec3 in = here - model.position(nodes.node[static_cast<std::size_t>((i + corners - 1) % corners)]);
    if (!(in.cross(out).dot(normal) > 0)) return false;
  }
  return true;
}

/// A direction turned about an axis (Rodrigues).
Vec3 turned(const Vec3& direction, const Vec3& axis, double degrees) {
  const double cosine = deterministic_cos_degrees(degrees);
  return cosine * direction + deterministic_sin_degrees(degrees) * axis.cross(direction) + (1 - cosine) * axis.dot(direction) * axis;
}

/// A shell's normal, turned by the average turn of its corners: by their own weights and by those of their images.
Vec3 turned_with(const Motion& motion, const ShellNodes& shell, double degrees, const Vec3& normal) {
  double own = 0, mirrored = 0;
  const int corners = shell.corners();
  for (int i = 0; i < corners; ++i) {
    const NodeIndex node = shell.node[static_cast<std::size_t>(i)];
    const auto at = std::lower_bound(motion.nodes.begin(), motion.nodes.end(), node);
    if (at == motion.nodes.end() || *at != node) continue;
    const auto place = static_cast<std::size_t>(at - motion.nodes.begin());
    const std::uint32_t image = motion.plane ? motion.mirrored[place].image : shape::Mirrored::kNone;
    own += (image != shape::Mirrored::kNone ? motion.mirrored[place].own : 1.0) * motion.weight[place] / corners;
    if (image != shape::Mirrored::kNone) mirrored += motion.mirrored[image].own * motion.weight[image] / corners;
  }
  const Vec3 turn = turned(normal, motion.axis.direction, degrees * own);
  return motion.plane ? turned(turn, motion.plane->mirrored(motion.axis.direction), -degrees * mirrored) : turn;
}

}  // namespace

std::vector<ShellIndex> inverted_shells(const Model& before, const Model& after, const ShellSet& shells, const Motion& motion,
                                        double degrees) {
  std::vector<ShellIndex> inverted;
  for (const ShellIndex shell : shells) {
    Vec3 was = normal_of(before, shell);
    if (!(was.squaredNorm() > 0)) continue;
    const Vec3 is = normal_of(after, shell);
    const bool was_convex = is_convex(before, shell, was);
    if (motion.kind == ShapingKind::rotate || motion.kind == ShapingKind::move)
      was = turned_with(motion, before.shell(shell), degrees, was);
    if (!(is.dot(was) > 0) || (was_convex && !is_convex(after, shell, is))) inverted.push_back(shell);
  }
  return inverted;
}

}  // namespace prismesh::mesh::document
