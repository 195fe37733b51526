// Carrying out what a repair wants: ids, cards, adjacency and judgements of what came and went. Private to mesh/document.
#pragma once

#include "mesh/document/document.h"
#include "mesh/document/edit_report.h"
#include "mesh/repair/restructuring.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::document {

/// What the deck and the document forbid around each node and shell: locked parts, held nodes, cards and elements that name them, mid-side
/// nodes, formats that can't write it. The document must outlive it.
repair::Rules rules_for(const Document& document, const Generation& generation);

/// Carries it out on `next`, a copy of the current generation: model, adjacency, marks (a new node is selected if all it comes from are),
/// judgement, weight, and the report's figures. Costs what the structure has changed since the deck was opened. Errors: no ids are left,
/// or the deck can't be written so (deck::can_restructure): where and why.
Result<void> restructure(const Document& document, const repair::Restructuring& change, Generation& next, EditReport& report);

/// The second half of it, for who has changed the model of `next` otherwise: brings adjacency, judgements and weight up to date, and gives
/// the marks their size. `moved`: nodes in both with other positions, ascending.
void settle_growth(const Settings& settings, const Generation& before, const NodeSet& moved, Generation& next);

/// The first half of it: the model alone. Errors: as restructure.
Result<void> carry_out(const Document& document, const repair::Restructuring& change, Model& model);

}  // namespace prismesh::mesh::document
