// Figures that commands compute, for text and JSON output. Inner to cli.
#pragma once

#include <optional>
#include <string>

#include "mesh/report/figures.h"

namespace prismesh::cli {

using mesh::report::FieldFigures;
using mesh::report::figures_of;
using mesh::report::PartFigures;

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
