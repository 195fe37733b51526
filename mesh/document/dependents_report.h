// Reports what an edit did to connections of the nodes it moved. Rules: docs/connections.md. Private to mesh/document.
#pragma once

#include "mesh/document/edit_report.h"
#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

/// Notes the joining cards of which only some nodes moved, and lists nodes that no longer lie on their sheets. `moved` ascending.
void report_dependents(const Generation& before, const Generation& after, const NodeSet& moved, EditReport& report);

}  // namespace prismesh::mesh::document
