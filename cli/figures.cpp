#include "cli/figures.h"

namespace prismesh::cli {

FieldFigures figures_of(const mesh::document::Field& field, const mesh::Model& model) {
  const mesh::document::FieldFigures& figures = field.figures;
  const std::string at = field.on_nodes ? "node:" + std::to_string(model.node_ids[figures.max_at])
                                        : "shell:" + std::to_string(model.shell_ids[figures.max_at]);
  return {figures.measured, figures.min, figures.mean, figures.max, at};
}

}  // namespace prismesh::cli
