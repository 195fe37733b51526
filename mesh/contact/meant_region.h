// A region that is to be separated. Private to mesh/contact.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "mesh/contact/perforations.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::contact {

struct MeantRegion {
  std::array<PartIndex, 2> part;           ///< of each side
  std::array<ShellSet, 2> shells;          ///< of each side
  std::optional<Perforation> perforation;  ///< else it is a penetration
  std::size_t upper = 0;                   ///< the side that directions point to: of a perforation the one that enters
  NodeSet entering;                        ///< of that side, on the wrong side of the other one
  std::optional<double> depth;
  double way = 0;    ///< how far the sides must move apart at least
  double least = 0;  ///< of a perforation: half of both thicknesses, and the gap
  std::array<bool, 2> may_move{true, true};
  std::string why_left;  ///< why it isn't tried; empty: it is

  std::size_t lower() const { return 1 - upper; }
};

/// "part 3".
inline std::string part_name(const Model& model, PartIndex part) {
  return part.valid() ? "part " + std::to_string((*model.parts)[part.value].id) : "a shell without part";
}

}  // namespace prismesh::mesh::contact
