// Figures that commands compute, for text and JSON output. Inner to cli.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/document/field.h"
#include "mesh/model/model.h"

namespace prismesh::cli {

struct PartFigures {
  std::int64_t id = 0;
  std::string name;
  std::size_t quads = 0;
  std::size_t tris = 0;
  std::optional<double> thickness;
  struct Box {
    mesh::Vec3 min = mesh::Vec3::Zero(), max = mesh::Vec3::Zero();
  };
  std::optional<Box> box;  ///< around the shells' corners; absent without shells
};

/// Counts the shells of each part; ascending by id.
std::vector<PartFigures> part_figures(const mesh::Model& model);

/// Statistics of a field's values.
struct FieldFigures {
  std::size_t measured = 0;
  double min = 0, mean = 0, max = 0;
  std::string min_at, max_at;  ///< "node:7"
};
FieldFigures figures_of(const mesh::document::Field& field, const mesh::Model& model);

struct Difference {
  std::size_t nodes_moved = 0;
  double max_displacement = 0;
  std::size_t nodes_added = 0;
  std::size_t nodes_removed = 0;
  std::size_t elements_added = 0;
  std::size_t elements_removed = 0;
  std::size_t elements_changed = 0;  ///< shells in both with other corners
  std::size_t lines_changed = 0;
  std::vector<std::int64_t> moved, added;        ///< ids of nodes, ascending
  std::optional<FieldFigures> displacement;      ///< of nodes in both; absent if there are none
  std::optional<FieldFigures> surface_distance;  ///< of the second deck's shell corners from the first deck's shells
};

/// The shortest distance between two sets.
struct Gap {
  double distance = 0;
  struct End {
    std::string entity;  ///< "node:7" or "shell:12"
    mesh::Vec3 point = mesh::Vec3::Zero();
  };
  End from;
  End to;
  std::optional<FieldFigures> nodes;  ///< of the first set: their distances from the second
};

}  // namespace prismesh::cli
