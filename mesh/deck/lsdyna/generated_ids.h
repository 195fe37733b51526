// The ids of nodes and elements that keywords generate when the solver starts: they aren't in the model, but nothing new may have them.
// Source: LS-DYNA Keyword User's Manual, "*ALE_STRUCTURED_MESH", "*CONTROL_FORMING_BLANKMESH", "*DEFINE_FORMING_BLANKMESH",
// "*PART_DUPLICATE",
// "*INCLUDE_AUTO_OFFSET", "*IGA_SHELL", "*ELEMENT_SHELL_NURBS_PATCH", "*DEFINE_CABLE".
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "mesh/deck/assembly/largest_ids.h"
#include "mesh/deck/data/taken_ids.h"
#include "mesh/deck/lsdyna/keyword.h"
#include "mesh/deck/lsdyna/parameters.h"

namespace prismesh::mesh::deck::lsdyna {

/// Collects blocks during the walk. Numbers of what a card generates are often not to be told from it: then all ids from the first on count
/// as taken.
class GeneratedIds {
 public:
  /// Precondition: `block` lies in `text`.
  void read(std::string_view text, const Block& block, const Parameters& parameters);
  /// `largest`: of the deck's nodes and elements.
  TakenIds finish(const LargestIds& largest) const;

 private:
  /// A structured mesh: its first ids, and the control points along its three directions.
  struct StructuredMesh {
    std::int64_t node = 0, element = 0;
    std::vector<std::int64_t> points;
  };
  struct Offsets {
    std::int64_t node = 0, element = 0;
  };

  std::vector<StructuredMesh> meshes_;
  std::map<std::int64_t, std::int64_t> point_counts_;  ///< by control points' id
  std::vector<Offsets> copies_;
  TakenIds open_;  ///< without an end that is known
};

}  // namespace prismesh::mesh::deck::lsdyna
