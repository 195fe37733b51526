// Finds the nodes that lie on sheets without being corners of them. Rules: docs/connections.md.
#pragma once

#include <span>
#include <vector>

#include "mesh/connections/node_on_sheet.h"

namespace prismesh::mesh::connections {

/// Nodes of welds, which may lie on a sheet: neither corners nor mid-side nodes, of elements connected to few others through such nodes.
/// `uses` ascending. The result is ascending by node, each once; shell and reach aren't set.
std::vector<NodeOnSheet> find_weld_nodes(const Model& model, std::span<const ElementUse> uses);

/// Those of the candidates that lie on a sheet, in the same order, with shell and reach. Costs the shells of the model.
std::vector<NodeOnSheet> find_sheets(const Model& model, std::vector<NodeOnSheet> candidates);

}  // namespace prismesh::mesh::connections
