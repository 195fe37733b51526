// Where the nodes of a weld must go so that it joins sheets that lie on each other. Rules: docs/welds.md.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

/// A node of a weld, in the order of its chain.
struct WeldEnd {
  Vec3 at = Vec3::Zero();
  bool fixed = false;  ///< it can't move
};

/// Lengths are in the deck's unit.
struct SeatOptions {
  double thickness_factor = 2;             ///< as FlangeOptions
  double gap = 0;                          ///< as SpotOptions
  std::optional<double> max_move;          ///< of a node; absent: as long as a joint at the sheet may be
  std::function<bool(PartIndex)> is_tied;  ///< whether the weld may join this part; empty: any
};

struct WeldSeat {
  std::vector<std::optional<Vec3>> to;  ///< per node; nothing: it stays
  std::string why;                      ///< why there is none, to be read after the weld's name; empty: there is one
};

/// Finds the sheets that lie on each other at the weld, and puts its nodes onto as many of them that are neighbours, so that they move the
/// least. A node that lies on its sheet stays, and the nodes keep their order along the stack. `ends`: at least two. `tree`: of the model,
/// without the shells that don't count.
WeldSeat seat_weld(const Model& model, const spatial::BoxTree& tree, std::span<const WeldEnd> ends, const SeatOptions& options);

}  // namespace prismesh::mesh::connections
