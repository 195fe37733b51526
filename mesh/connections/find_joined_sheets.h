// Finds the sheets that a deck's elements and cards join: welds, adhesives, rivets. Rules: docs/connections.md.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mesh/connections/joined_sheets.h"
#include "mesh/connections/node_on_sheet.h"
#include "mesh/model/in_sight.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::connections {

/// What may join sheets: the nodes of an element that isn't a shell, or those that a card names.
struct Joint {
  NodeSet ends;                                 ///< at least two
  std::optional<ElementClass> element_class{};  ///< nothing: it is a card
  std::size_t of = 0;                           ///< the element's index, or the number of the card
};

/// The beams, solids, thick shells, springs and connectors of the model with at least two nodes, then the cards likewise.
std::vector<Joint> possible_joints(const Model& model, std::span<const NodeSet> cards);

/// The pairs of shells that each of the possible joints joins, as find_joints() finds them; none: it is no joint. Costs a pass over the
/// shells of the model if an end is no node of a shell.
std::vector<std::vector<JoinedSheets::Pair>> joined_by_each(const Model& model, std::span<const Joint> joints, OutOfSight out_of_sight);

/// The shells at each tied node, with the shell it is tied to, where it lies on that.
std::vector<JoinedSheets::Pair> joined_by_ties(const Model& model, std::span<const NodeOnSheet> on_sheets, OutOfSight out_of_sight);

/// Finds the shells that beams, solids, thick shells, springs and connectors join, and those that `cards` join: the nodes that each of the
/// deck's welds, rivets and small rigid bodies names. An end lies on the visible shells at its node; if no shell uses the node, on the
/// closest visible shell if that is within its placed reach (mesh/connections/sheet_reach.h). Two ends join their shells unless these touch
/// each other (then the element stiffens a sheet) or lie farther apart than a joint may extend (kMaxJointInSides). Of `on_sheets` the tied
/// nodes join the shells at them to the shell they are tied to, as long as they lie on it; other nodes don't count. Each pair in one order,
/// some several times. Costs the elements, and the shells of the model if an end is no node of a shell.
std::vector<JoinedSheets::Pair> find_joints(const Model& model, std::span<const NodeSet> cards, OutOfSight out_of_sight,
                                            std::span<const NodeOnSheet> on_sheets = {});

/// These, and a sheet without any joint to another is joined to those it touches: find_touching() says when. Costs the shells of the model.
JoinedSheets find_joined_sheets(const Model& model, std::span<const NodeSet> cards, OutOfSight out_of_sight,
                                std::span<const NodeOnSheet> on_sheets = {});

}  // namespace prismesh::mesh::connections
