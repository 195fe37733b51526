// Finds the sheets of a generation that its deck joins. Private to mesh/document.
#pragma once

#include "mesh/connections/joined_sheets.h"
#include "mesh/document/generation.h"
#include "mesh/model/in_sight.h"

namespace prismesh::mesh::document {

/// By elements, by the cards of the deck that join sheets, and by tied nodes. Costs the elements, and the shells if an end is no node of a
/// shell.
connections::JoinedSheets joined_sheets(const Generation& generation, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::document
