// Figures of parts and of fields, for reports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/document/field.h"
#include "mesh/model/model.h"

namespace prismesh::mesh::report {

struct PartFigures {
  std::int64_t id = 0;
  std::string name;
  std::size_t quads = 0;
  std::size_t tris = 0;
  std::optional<double> thickness;
  struct Box {
    Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  };
  std::optional<Box> box;  ///< around the shells' corners; absent without shells
};

/// Counts the shells of each part; ascending by id.
std::vector<PartFigures> part_figures(const Model& model);

/// Statistics of a field's values.
struct FieldFigures {
  std::size_t measured = 0;
  double min = 0, mean = 0, max = 0;
  std::string min_at, max_at;  ///< "node:7"
};
FieldFigures figures_of(const document::Field& field, const Model& model);

}  // namespace prismesh::mesh::report
