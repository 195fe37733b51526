// Computes the figures of `check`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/document/document.h"
#include "mesh/quality/report.h"
#include "mesh/quality/structure.h"

namespace prismesh::mesh::report {

struct ChordalFigures {
  double mean = 0, max = 0;  ///< deck's length unit
  std::size_t measured = 0;
  std::optional<mesh::ShellIndex> worst;
};

struct CheckFigures {
  mesh::quality::Report report;
  std::vector<mesh::quality::PartReport> parts;
  mesh::quality::Structure structure;
  std::optional<ChordalFigures> chordal;  ///< if it was asked for
  mesh::quality::Grade triangles = mesh::quality::Grade::ok;
  std::vector<std::string> unknown;  ///< a sentence for each figure that can't be computed
};

/// Computes the figures of the given shells; nullptr: of all. `chordal`: also the distance of edges from the smooth surface, which takes
/// longer.
CheckFigures check_figures(const mesh::document::Document& document, const mesh::ShellSet* shells, bool chordal);

mesh::quality::Grade grade_of_triangles(double percent, const mesh::quality::Criteria& criteria);

}  // namespace prismesh::mesh::report
