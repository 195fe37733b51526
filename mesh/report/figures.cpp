#include "mesh/report/figures.h"

namespace prismesh::mesh::report {

namespace {

/// Makes the box hold the point, unless a coordinate isn't finite.
void grow(std::optional<PartFigures::Box>& box, const Vec3& point) {
  if (!point.allFinite()) return;
  if (!box) box = PartFigures::Box{point, point};
  box->min = box->min.cwiseMin(point);
  box->max = box->max.cwiseMax(point);
}

}  // namespace

std::vector<PartFigures> part_figures(const Model& model) {
  std::vector<PartFigures> figures;
  for (const Part& part : *model.parts) figures.push_back({part.id, part.name, 0, 0, part.thickness, std::nullopt});
  for (std::size_t shell = 0; shell < model.shell_count(); ++shell) {
    const PartIndex part = model.shell_parts[shell];
    if (!part.valid() || model.is_removed(ShellIndex(shell))) continue;  // a removed one has no corners
    PartFigures& of_part = figures[part.value];
    const ShellNodes& nodes = model.shell_nodes[shell];
    ++(nodes.is_triangle() ? of_part.tris : of_part.quads);
    for (const NodeIndex node : nodes.node) grow(of_part.box, model.positions[node.value]);
  }
  return figures;
}

FieldFigures figures_of(const document::Field& field, const Model& model) {
  const document::FieldFigures& figures = field.figures;
  const auto entity = [&](std::uint32_t at) {
    return field.on_nodes ? "node:" + std::to_string(model.node_ids[at]) : "shell:" + std::to_string(model.shell_ids[at]);
  };
  return {figures.measured, figures.min, figures.mean, figures.max, entity(figures.min_at), entity(figures.max_at)};
}

}  // namespace prismesh::mesh::report
