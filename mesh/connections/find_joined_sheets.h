// Finds the sheets that a deck's elements and cards join: welds, adhesives, rivets. Rules: docs/connections.md.
#pragma once

#include <span>

#include "mesh/connections/joined_sheets.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::connections {

/// Finds the shells that beams, solids, thick shells, springs and connectors join, and those that `cards` join: the nodes that each of the
/// deck's welds and rivets names. An end lies on the visible shells at its node; if no shell uses the node, on the closest visible shell if
/// that is within its placed reach (mesh/connections/sheet_reach.h). Two ends join their shells unless these touch each other (then the
/// element stiffens a sheet) or lie farther apart than a joint may extend (kMaxJointInSides). A sheet without any joint to another is
/// joined to those it touches: find_touching() says when. Costs the shells of the model.
JoinedSheets find_joined_sheets(const Model& model, std::span<const NodeSet> cards, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::connections
