// Candidate operations for a shell.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/reshaping.h"

namespace prismesh::mesh::repair {

struct Candidate {
  std::optional<Operation> operation;  ///< none: it only smooths nodes
  std::function<Refusal()> apply;      ///< changes the patch of the context that it was found for
};

/// Candidates on a shell and its neighbours, the simplest first.
std::vector<Candidate> candidates_for(const RepairContext& context, LocalShell shell);

/// The splits of a quad along its diagonals; first the diagonal across which it is bent more. Empty for a triangle.
std::vector<Candidate> splits_of(const RepairContext& context, LocalShell shell);

/// Candidates on the strip of quads across edge `edge` (0 or 1) of a quad and the opposite edge: to divide it if it is wide there, to
/// remove it if it is narrow.
std::vector<Candidate> strips_for(const RepairContext& context, LocalShell shell, int edge);

/// Candidates that may remove triangles near a triangle, or separate it from another one.
std::vector<Candidate> tidying_for(const RepairContext& context, LocalShell shell);

}  // namespace prismesh::mesh::repair
