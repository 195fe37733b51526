// Finds the flanges of a generation's visible parts (mesh/connections/find_flanges.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/connections/flange.h"
#include "mesh/document/edit.h"
#include "mesh/document/generation.h"
#include "mesh/document/selection.h"

namespace prismesh::mesh::document {

struct FlangeWish {
  std::optional<std::string> select{};  ///< an expression: only flanges that have one of its shells
  double gap = 0;                       ///< sheets may be farther apart by this, deck's length unit
  std::optional<double> max_width{};    ///< absent: 40 times the thickness
};

/// The flanges, the longest first. Errors: those of the expression, cancelled.
Result<connections::Flanges> find_flanges(const Generation& generation, const FlangeWish& wish, const Progress& progress = {});

/// The flange at the edit's place, or all flanges between its parts. `who` begins the errors: the edit's name. Errors: as flange_at.
Result<std::vector<connections::Flange>> flanges_wanted(const Generation& generation, const SelectFlange& edit, const std::string& who,
                                                        const Progress& progress = {});

/// The shells of all sheets of the flange at the edit's place, or of all flanges between its parts. Errors: no such node or part, neither
/// or both named, no flange there; cancelled.
Result<Selection> flange_at(const Generation& generation, const SelectFlange& edit, const Progress& progress = {});

}  // namespace prismesh::mesh::document
