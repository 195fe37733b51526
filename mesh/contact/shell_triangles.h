// The triangles of a shell with their nodes. Private to mesh/contact.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "mesh/contact/orientation.h"
#include "mesh/contact/triangle_crossing.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::contact {

inline bool can_decide(const Vec3& point) { return point.cwiseAbs().maxCoeff() <= kMaxExactCoordinate && point.allFinite(); }

struct ShellTriangle {
  std::array<NodeIndex, 3> node;
  Triangle at;
};

/// Calls `visit(const ShellTriangle&)` for each triangle of a shell: a quad has two, at its diagonal from the first corner to the third.
/// Those with a corner that isn't finite, or repeated, or too far away are left out; those with corners on a line aren't.
template <class Visit>
void each_shell_triangle(const Model& model, ShellIndex shell, Visit&& visit) {
  if (model.is_removed(shell)) return;
  const ShellNodes& nodes = model.shell(shell);
  for (std::size_t second = 1; second <= (nodes.is_triangle() ? 1u : 2u); ++second) {
    const ShellTriangle triangle{
        {nodes.node[0], nodes.node[second], nodes.node[second + 1]},
        {model.position(nodes.node[0]), model.position(nodes.node[second]), model.position(nodes.node[second + 1])}};
    if (can_decide(triangle.at[0]) && can_decide(triangle.at[1]) && can_decide(triangle.at[2])) visit(triangle);
  }
}

}  // namespace prismesh::mesh::contact
