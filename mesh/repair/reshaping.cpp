#include "mesh/repair/reshaping.h"

#include <algorithm>

namespace prismesh::mesh::repair {

Refusal refuse_reshaping(const Patch& patch, LocalShell shell, std::size_t corners) {
  const PatchShell& s = patch.shell(shell);
  if ((s.rules & kKeepsNodes) != 0) return "a shell there has to keep its nodes";
  if ((s.rules & kNoTriangle) != 0 && static_cast<int>(corners) != corner_count(s.corners))
    return "a shell there can't change between quad and triangle";
  for (const LocalNode corner : s.corners)
    if (!patch.node(corner).is_whole) return "a shell there has a node that can't be worked on";
  return std::nullopt;
}

Refusal refuse_dividing(const Patch& patch, LocalShell shell, std::size_t corners) {
  if ((patch.shell(shell).rules & kIndivisible) != 0) return "a shell there can't be divided";
  return refuse_reshaping(patch, shell, corners);
}

Corners corners_along(const Patch& patch, const Loop& loop, const Vec3& direction) {
  std::size_t best = 0;
  double max_along = -2;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3 edge = patch.position(loop[(i + 1) % loop.size()]) - patch.position(loop[i]);
    const double length = edge.norm();
    const double along = length > 0 ? edge.dot(direction) / length : -1;
    if (along > max_along + 1e-9) {
      max_along = along;
      best = i;
    }
  }
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = loop[(best + std::min(i, loop.size() - 1)) % loop.size()];
  return corners;
}

Vec3 first_edge(const Patch& patch, LocalShell shell) {
  const Corners& corners = patch.shell(shell).corners;
  const Vec3 edge = patch.position(corners[1]) - patch.position(corners[0]);
  const double length = edge.norm();
  return length > 0 ? Vec3(edge / length) : Vec3::Zero();
}

}  // namespace prismesh::mesh::repair
