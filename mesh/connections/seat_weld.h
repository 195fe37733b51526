// Where the ends of a weld must go so that it joins two sheets. Rules: docs/welds.md.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

/// Lengths are in the deck's unit.
struct SeatOptions {
  double thickness_factor = 2;     ///< as FlangeOptions
  double gap = 0;                  ///< as SpotOptions
  std::optional<double> max_move;  ///< of an end; absent: as long as a joint at the sheet may be
};

struct WeldSeat {
  std::array<std::optional<Vec3>, 2> to;  ///< per end; nothing: it stays
  std::string why;                        ///< why there is none, to be read after the weld's name; empty: there is one
};

/// Finds the sheets that lie on each other at the weld, and puts each end onto one of two that are neighbours, so that they move the least.
/// An end that lies on its sheet stays. `fixed`: an end that can't move. `tree`: of the model.
WeldSeat seat_weld(const Model& model, const spatial::BoxTree& tree, const std::array<Vec3, 2>& ends, const std::array<bool, 2>& fixed,
                   const SeatOptions& options);

}  // namespace prismesh::mesh::connections
