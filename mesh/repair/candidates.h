// Candidate operations for a shell.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mesh/repair/context.h"
#include "mesh/repair/operation.h"
#include "mesh/repair/reshaping.h"
#include "mesh/repair/strips.h"

namespace prismesh::mesh::repair {

struct Candidate {
  std::optional<Operation> operation;  ///< none: it only smooths nodes
  std::function<Refusal()> apply;      ///< changes the patch of the context that it was found for
};

/// Candidates on a shell and its neighbours, the simplest first.
std::vector<Candidate> candidates_for(const RepairContext& context, LocalShell shell);

/// The splits of a quad along its diagonals; first the diagonal across which it is bent more. Empty for a triangle.
std::vector<Candidate> splits_of(const RepairContext& context, LocalShell shell);

/// What one operation by hand can do at a shell: split it, collapse an edge, divide it or divide it anew together with a neighbour.
std::vector<Candidate> single_operations_at(const RepairContext& context, LocalShell shell);

/// Ways to divide a strip, or to remove it.
struct StripCandidates {
  Operation operation;
  std::vector<StripQuad> quads;
  std::vector<Candidate> candidates;
};

/// Candidates on strips of quads across edge `edge` (0 or 1) of a quad and the opposite edge, of several lengths: to divide them if the
/// quad is wide there, to remove them if it is narrow.
std::vector<StripCandidates> strips_for(const RepairContext& context, LocalShell shell, int edge);

/// Candidates that may remove triangles near a triangle, or separate it from another one.
std::vector<Candidate> tidying_for(const RepairContext& context, LocalShell shell);

}  // namespace prismesh::mesh::repair
