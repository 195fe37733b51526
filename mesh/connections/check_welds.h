// Checks welds against the sheets that they are to join. Rules: docs/welds.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/connections/node_on_sheet.h"
#include "mesh/model/model.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::connections {

/// A weld: an element that is to join sheets. Elements of a chain through a stack of sheets are welds each.
struct CheckedWeld {
  ElementClass element_class = ElementClass::beam;
  std::uint32_t element = 0;      ///< index in Model::elements[element_class]
  Vec3 at = Vec3::Zero();         ///< the mean of its nodes
  std::vector<PartIndex> sheets;  ///< parts that it joins, ascending, each once
  bool joined = false;            ///< it joins two sheets
  /// Of its ends that lie on no sheet: the one that is farthest, and its distance from the nearest sheet, deck's unit; infinite if there is
  /// none. Of solids only if the weld joins nothing: their inner nodes lie on none.
  std::optional<double> loose_by;
  NodeIndex loose_end;
  /// The distance from the nearest free edge of a sheet that it joins, if that is within the asked one, deck's unit.
  std::optional<double> edge_distance;
  /// Another weld of the same sheets nearer than the asked pitch: its place in the list, and how far its middle is, deck's unit.
  std::optional<std::uint32_t> neighbour;
  double neighbour_distance = 0;
};

/// Lengths are in the deck's unit; 0: not checked.
struct WeldCheckOptions {
  double min_edge_distance = 0;
  double min_pitch = 0;
};

/// The welds of the model in the order of class and element: elements of groups that may be welds (find_weld_nodes()), and those that join
/// sheets (joined_by_each()). Hidden parts aren't told from others. Costs the shells and the elements. `uses` ascending.
/// Preconditions: the model has its adjacency, the tree is that of the model, the lengths are finite and at least 0.
std::vector<CheckedWeld> check_welds(const Model& model, const spatial::BoxTree& tree, std::span<const ElementUse> uses,
                                     const WeldCheckOptions& options);

}  // namespace prismesh::mesh::connections
