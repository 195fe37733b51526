#include "mesh/contact/contact_surface.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/Dense>

#include "mesh/contact/shell_triangles.h"
#include "mesh/model/adjacency.h"

namespace prismesh::mesh::contact {

namespace {

/// Directions in which the normals at a node differ less aren't decided by them: of the greatest square. Within some 13 degrees.
constexpr double kFlat = 0.05;

Vec3 normal_of_shell(const Model& model, ShellIndex shell) {
  Vec3 vector = Vec3::Zero();
  each_shell_triangle(model, shell, [&](const ShellTriangle& t) { vector += (t.at[1] - t.at[0]).cross(t.at[2] - t.at[0]); });
  const double length = vector.norm();
  return length > 0 ? Vec3(vector / length) : Vec3(Vec3::Zero());
}

/// The shortest move whose part along each normal is nearest to that shell's offset.
Vec3 move_at(const Model& model, const std::vector<double>& offset, NodeIndex node) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Vec3 sum = Vec3::Zero();
  for (const ShellIndex shell : model.adjacency->shells_of(node)) {
    const Vec3 normal = normal_of_shell(model, shell);
    squares += normal * normal.transpose();
    sum += offset[shell.value] * normal;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(squares);
  const double greatest = solved.eigenvalues()[2];
  Vec3 move = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (solved.eigenvalues()[i] > kFlat * greatest) {
      const Vec3 direction = solved.eigenvectors().col(i);
      move += direction.dot(sum) / solved.eigenvalues()[i] * direction;
    }
  return move;
}

}  // namespace

Model contact_surface(const Model& model, const std::vector<double>& offset) {
  Model surface = model;
  for (std::size_t n = 0; n < model.node_count(); ++n) {
    const auto shells = model.adjacency->shells_of(NodeIndex(n));
    if (std::none_of(shells.begin(), shells.end(), [&](ShellIndex shell) { return offset[shell.value] != 0; })) continue;
    const Vec3 moved = model.positions[n] + move_at(model, offset, NodeIndex(n));
    if (moved.allFinite()) surface.positions.set(n, moved);
  }
  return surface;
}

}  // namespace prismesh::mesh::contact
