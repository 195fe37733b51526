// Finds the regions in which shells cross.
#pragma once

#include <vector>

#include "mesh/contact/perforations.h"
#include "mesh/contact/shell_crossings.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// Groups pairs of shells into regions: two pairs of the same two parts belong together if the shells of each side are the same or share a
/// node. Returns the regions, the longest curve first, then by parts and shells. Preconditions: the pairs are ascending,
/// the model has its adjacency.
std::vector<Perforation> group_crossings(const Model& model, const std::vector<ShellCrossing>& crossings);

/// The order of regions.
bool comes_first(const Perforation& x, const Perforation& y);

/// Both steps. Preconditions and what counts as a crossing: find_shell_crossings.
std::vector<Perforation> find_perforations(const Model& model, const spatial::BoxTree& tree);

}  // namespace prismesh::mesh::contact
