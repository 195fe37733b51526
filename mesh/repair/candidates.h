// What could be done about a shell.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

struct Candidate {
  std::optional<Operation> operation;  ///< none: nodes find better places only
  std::function<Refusal()> apply;      ///< to the context it was found at
};

/// Operations on a shell and its neighbours that are worth a try, the simplest first.
std::vector<Candidate> candidates_for(const RepairContext& context, LocalShell shell);

/// What can be done with the strip across edge `edge` of a quad (0 or 1) and the one opposite: divided if it is wide there, or taken out if
/// it is narrow.
std::vector<Candidate> strips_for(const RepairContext& context, LocalShell shell, int edge);

/// Those that may rid a triangle's neighbourhood of triangles, or part it from another one.
std::vector<Candidate> tidying_for(const RepairContext& context, LocalShell shell);

}  // namespace prismesh::mesh::repair
