// Figures that commands work out, for text and JSON alike. Inner to cli.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/model/model.h"

namespace prismesh::cli {

struct PartFigures {
  std::int64_t id = 0;
  std::string name;
  std::size_t quads = 0;
  std::size_t tris = 0;
  std::optional<double> thickness;
};

/// Parts ascending by id, with their shells counted.
std::vector<PartFigures> part_figures(const mesh::Model& model);

struct Difference {
  std::size_t nodes_moved = 0;
  double max_displacement = 0;
  std::size_t nodes_added = 0;
  std::size_t nodes_removed = 0;
  std::size_t elements_added = 0;
  std::size_t elements_removed = 0;
  std::size_t lines_changed = 0;
};

/// The shortest way between two sets.
struct Gap {
  double distance = 0;
  struct End {
    std::string entity;  ///< "node:7" or "shell:12"
    mesh::Vec3 point = mesh::Vec3::Zero();
  };
  End from;
  End to;
};

}  // namespace prismesh::cli
