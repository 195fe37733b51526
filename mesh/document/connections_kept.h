// Whether nodes that lie on sheets still do, and how a report names them. Rules: docs/connections.md. Private to mesh/document.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/document/dependents.h"
#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// Indices into Dependents::on_sheets, ascending: nodes that moved, or whose shells have a corner that did. `moved` ascending.
std::vector<std::uint32_t> doubtful_connections(const Dependents& dependents, const Model& model, const NodeSet& moved);

/// The distance of the node from the sheet it lies on; 0 where node or shell is removed.
double gap_from_sheet(const Model& model, const NodeOnSheet& rest);

/// "beam:9 at node:901 no longer lies on shell:6, it is 8.1 away". `gap`: as gap_from_sheet() gives it.
std::string lost_connection(const Generation& before, const NodeOnSheet& rest, double gap);

/// The card as a report names it: "*CONSTRAINED_NODAL_RIGID_BODY 5".
std::string card_of(const DeckRelations& relations, std::uint32_t referrer);

}  // namespace prismesh::mesh::document
