// Finds the sheets that a deck's elements and cards join: welds, adhesives, rivets. Rules: docs/connections.md.
#pragma once

#include <span>

#include "mesh/connections/joined_sheets.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::connections {

/// The max length of a joint, in longest sides of the shells at its ends. What is longer is a strut.
inline constexpr double kMaxJointInSides = 2;

/// Finds the shells that beams, solids, thick shells, springs and connectors join, and those that `cards` join: the nodes that each of the
/// deck's welds and rivets names. An end lies on the visible shells at its node; if no shell uses the node, on the closest visible shell if
/// that is within its placed reach (mesh/connections/sheet_reach.h). Two ends join their shells unless these touch each other (then the
/// element stiffens a sheet) or lie farther apart than kMaxJointInSides. Costs the model if an end is no node of a shell.
JoinedSheets find_joined_sheets(const Model& model, std::span<const NodeSet> cards, OutOfSight out_of_sight);

}  // namespace prismesh::mesh::connections
