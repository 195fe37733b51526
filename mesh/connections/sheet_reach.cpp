#include "mesh/connections/sheet_reach.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::connections {

double mean_side(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double around = 0;
  const int corners = nodes.corners();
  for (int i = 0; i < corners; ++i) around += (model.position(nodes.node[(i + 1) % corners]) - model.position(nodes.node[i])).norm();
  return around / corners;
}

double max_side(const Model& model, ShellIndex shell) {
  const ShellNodes& nodes = model.shell(shell);
  double max2 = 0;
  for (std::size_t i = 0; i < 4; ++i)
    max2 = std::max(max2, (model.position(nodes.node[(i + 1) % 4]) - model.position(nodes.node[i])).squaredNorm());
  return std::sqrt(max2);
}

double sheet_reach(const Model& model, ShellIndex shell, Attachment attachment) {
  const bool placed = attachment == Attachment::placed;
  const double thickness = quality::thickness_of(model, shell.value);
  const double by_thickness = thickness > 0 ? (placed ? kPlacedReachInThicknesses : kTiedReachInThicknesses) * thickness : 0.0;
  if (attachment == Attachment::touching) return by_thickness;
  return std::max((placed ? kPlacedReachInSides : kTiedReachInSides) * mean_side(model, shell), by_thickness);
}

double max_joint_length(const Model& model, ShellIndex shell) { return kMaxJointInSides * max_side(model, shell); }

}  // namespace prismesh::mesh::connections
