// What could be done about a shell.
#pragma once

#include <functional>
#include <vector>

#include "mesh/repair/operations.h"

namespace prismesh::mesh::repair {

struct Candidate {
  Operation operation = Operation::split;
  std::function<Refusal()> apply;  ///< to the site it was found at
};

/// Operations on a shell and its neighbours that are worth a try, the simplest first. `most_triangles`: whether two triangles may come from
/// two quads.
std::vector<Candidate> candidates_for(const Site& site, LocalShell shell);

/// Those that only divide a shell and a neighbour otherwise: to be rid of triangles.
std::vector<Candidate> redivisions_for(const Site& site, LocalShell shell);

}  // namespace prismesh::mesh::repair
