// Finds the sheets of a generation that its deck joins.
#pragma once

#include <vector>

#include "mesh/connections/joined_sheets.h"
#include "mesh/document/generation.h"
#include "mesh/model/in_sight.h"

namespace prismesh::mesh::document {

/// By elements, by the cards of the deck that join sheets, and by tied nodes; a sheet without any of these, to those it touches. Costs the
/// elements, and the shells if an end is no node of a shell.
connections::JoinedSheets joined_sheets(const Generation& generation, OutOfSight out_of_sight);

/// The pairs of shells that elements, cards and tied nodes join: connections::find_joints. Hidden parts count.
std::vector<connections::JoinedSheets::Pair> joints(const Generation& generation);

}  // namespace prismesh::mesh::document
