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
  const bool tied = attachment == Attachment::tied;
  const double thickness = quality::thickness_of(model, shell.value);
  const double by_thickness = thickness > 0 ? (tied ? kTiedReachInThicknesses : kPlacedReachInThicknesses) * thickness : 0.0;
  return std::max((tied ? kTiedReachInSides : kPlacedReachInSides) * mean_side(model, shell), by_thickness);
}

}  // namespace prismesh::mesh::connections
