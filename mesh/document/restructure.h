// Applies a change of the structure to a generation: ids, adjacency, marks and quality of added and removed entities. Private to
// mesh/document.
#pragma once

#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/model/topology_change.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::document {

/// What the deck and the document forbid to change, for each node and shell: locked parts, held nodes, entities that cards and elements
/// name, mid-side nodes, changes that the format can't write. The document must outlive the rules.
repair::Rules rules_for(const Document& document, const Generation& generation);

/// Applies the change to `next`, a copy of the current generation: model, adjacency, marks (a new node is selected if all it comes from
/// are), quality, weight, and the report's figures. Costs all changes of the structure since the deck was opened. Errors: no ids are left,
/// or the deck can't be written (deck::can_restructure), with place and reason.
Result<void> restructure(const Document& document, const repair::Restructuring& change, Generation& next, EditReport& report);

/// The second half of `restructure`: `next` has the changed model.
void finish_restructuring(const Document& document, Generation& next, EditReport& report);

/// The part of it that a delta needs, for a `next` whose model was changed otherwise: updates adjacency, quality, clusters and weight, and
/// resizes the marks. `moved`: nodes of both whose positions differ, ascending.
void settle_growth(const Generation& before, const NodeSet& moved, Generation& next);

/// Says that new nodes and elements may have numbers that a missing include uses.
void note_missing_files(const Document& document, const Changes& changes, EditReport& report);

/// The first half of `restructure`: changes the model alone. Errors: as restructure.
Result<void> carry_out(const Document& document, const repair::Restructuring& change, Model& model);

}  // namespace prismesh::mesh::document
