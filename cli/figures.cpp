#include "cli/figures.h"

namespace prismesh::cli {

FieldFigures figures_of(const mesh::document::Field& field, const mesh::Model& model) {
  const mesh::document::FieldFigures& figures = field.figures;
  const auto entity = [&](std::uint32_t at) {
    return field.on_nodes ? "node:" + std::to_string(model.node_ids[at]) : "shell:" + std::to_string(model.shell_ids[at]);
  };
  return {figures.measured, figures.min, figures.mean, figures.max, entity(figures.min_at), entity(figures.max_at)};
}

}  // namespace prismesh::cli
