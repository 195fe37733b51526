// What joins sheets where separating moves them: welds go along with their sheets, and none may be lost. Private to mesh/document.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/connections/find_joined_sheets.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/generation.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::document {

class KeptWelds {
 public:
  /// The generation must outlive it. Finds what joins its sheets: costs the elements, and the shells if an end is no node of a shell.
  explicit KeptWelds(const Generation& generation);

  /// Whether an element may go along with one of its nodes: it joins two sheets, or has no other node.
  bool may_follow(const ElementUse& use) const;
  /// Likewise a card; `card`: index into Dependents::joining_cards.
  bool may_follow(std::uint32_t card) const;
  /// As joints() gives them.
  std::vector<connections::JoinedSheets::Pair> pairs() const;

  /// Moves the nodes of welds that lie on sheets along with these, in `after`, which has `moved` (ascending) elsewhere than `before`.
  /// Returns those that it moved, ascending.
  NodeSet carry(const Model& before, const NodeSet& moved, Model& after) const;
  /// What would be lost between the two, as a sentence; empty: nothing. A node no longer lies on its sheet; a weld no longer joins parts
  /// that it joined, by the rules by which it did; a solid of it turns inside out. `moved`: with what carry() moved, ascending. Costs what
  /// is near, and a pass over the shells if a weld there has an end that is no node of a shell.
  std::string why_lost(const Model& before, const Model& after, const NodeSet& moved) const;

 private:
  using PartPairs = std::vector<std::pair<PartIndex, PartIndex>>;
  const connections::Joint* joint_of(std::optional<ElementClass> element_class, std::size_t of) const;
  bool joins(const connections::Joint* joint) const;
  std::string name_of(const connections::Joint& joint) const;
  std::string why_off_sheet(const Model& before, const Model& after, const NodeSet& moved) const;
  std::string why_torn(const Model& before, const Model& after, const NodeSet& moved) const;
  std::string why_inside_out(const Model& before, const Model& after, const NodeSet& moved) const;

  const Generation& generation_;
  std::vector<connections::Joint> joints_;
  std::vector<std::vector<connections::JoinedSheets::Pair>> joined_;  ///< by joint
  std::vector<std::pair<ShellIndex, std::uint32_t>> joints_at_;       ///< ascending: of shells and joints
};

}  // namespace prismesh::mesh::document
