// Whether welds, adhesives and ties join two parts at a place.
#pragma once

#include <compare>
#include <span>
#include <vector>

#include "mesh/connections/joined_sheets.h"
#include "mesh/contact/contact_thickness.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::contact {

class JointsOfParts {
 public:
  /// The pairs in any order. The model must outlive it.
  JointsOfParts(const Model& model, std::span<const connections::JoinedSheets::Pair> joints);

  /// Whether a joint joins shells of the two parts, and both touch the box about the given shells, grown by the greatest thicknesses of
  /// both sides.
  bool join_there(PartIndex part_a, PartIndex part_b, const ShellSet& shells_a, const ShellSet& shells_b,
                  const ContactThickness& thickness) const;

 private:
  struct Joint {
    PartIndex part_a, part_b;  ///< part_a <= part_b
    ShellIndex a, b;
    auto operator<=>(const Joint&) const = default;
  };

  const Model& model_;
  std::vector<Joint> joints_;  ///< ascending
};

}  // namespace prismesh::mesh::contact
