// What to separate, and what became of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/connections/joined_sheets.h"
#include "mesh/contact/contact_thickness.h"
#include "mesh/model/chunked_array.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/criteria.h"
#include "mesh/quality/shell_state.h"
#include "mesh/spatial/box_tree.h"

namespace prismesh::mesh::contact {

/// The model in which regions are separated, and what its nodes may do. Everything named must outlive it.
struct SeparationInput {
  const Model& model;  ///< with its adjacency
  const spatial::BoxTree& tree;
  const ContactThickness& thickness;
  const quality::SizedCriteria& criteria;
  const ChunkedArray<quality::ShellState>& states;          ///< what the criteria say of each shell
  std::span<const connections::JoinedSheets::Pair> joints;  ///< pairs of shells that the deck joins
  /// Why a node can't move, as a predicate ("are locked"); empty: it can.
  std::function<std::string_view(NodeIndex)> why_stays;
  /// Moves what goes along with the shells at the nodes `moved`, as welds that lie on them, in `after`, which has these elsewhere than
  /// `before`. Returns the nodes that it moved, ascending, none of them of a shell. Null: nothing goes along.
  std::function<NodeSet(const Model& before, const NodeSet& moved, Model& after)> carry{};
  /// What `after` loses that `before` had, as a weld between parts, as a sentence; empty: nothing. Null: nothing can be lost.
  std::function<std::string(const Model& before, const Model& after, const NodeSet& moved)> why_lost{};
};

enum class MovingSide : std::uint8_t {
  both,     ///< of a perforation the piece that enters; of a penetration both halfway, or one side where the other can't move
  on,       ///< only what is among `on`
  against,  ///< only what is among `against`
};

/// Lengths are in the deck's unit.
struct SeparationWish {
  /// A region is meant if one of its sides has shells of `on` and its other side shells of `against`. Ascending; null: all.
  const ShellSet* on = nullptr;
  const ShellSet* against = nullptr;
  std::optional<Vec3> at;  ///< only the region that is nearest to it
  bool perforations = true;
  bool penetrations = true;
  bool joined = false;  ///< regions, too, at which a joint joins the parts
  double gap = 0;       ///< how far faces must be apart; finite, at least 0
  MovingSide move = MovingSide::both;
  std::optional<Vec3> direction;   ///< along which the side that moves goes, of any length but zero; absent: away from the other side
  std::optional<double> max_move;  ///< of each node; a region that needs more is left
  double allowed_depth = 0;        ///< penetrations up to it may stay, and remain of what is separated
};

/// A region that was left as it was.
struct LeftRegion {
  PartIndex part_a, part_b;  ///< part_a <= part_b; invalid for shells without a part
  std::string why;           ///< a sentence for the user
};

struct Separation {
  std::size_t regions_before = 0;  ///< that are meant
  std::vector<LeftRegion> left;    ///< in the order in which they were tried: perforations first, the deepest first
  double depth_before = 0;         ///< the greatest of the regions meant, as find_penetrations and perforation_depths give it
  double depth_after = 0;          ///< the same of those that are left
  double largest_move = 0;
  NodeSet nodes;                ///< that move
  std::vector<Vec3> positions;  ///< of these nodes

  std::size_t removed() const { return regions_before - left.size(); }
};

}  // namespace prismesh::mesh::contact
