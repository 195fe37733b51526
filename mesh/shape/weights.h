// Computes how strongly each selected node follows the grab: a profile of d_border / (d_origin + d_border), distances along the surface.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/connections/joined_sheets.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/shape/axis.h"

namespace prismesh::mesh::shape {

enum class Profile : std::uint8_t { constant, linear, smooth, sharp, root, sphere, inverse_square, gaussian };
std::string_view name(Profile profile);
std::optional<Profile> profile_from(std::string_view name);

/// How weight falls from 1 at the origin to 0 at the border.
struct Falloff {
  Profile profile = Profile::smooth;
  double flat = 0;            ///< 0..1: share of the distance from the origin to the border on which the weight stays 1; any profile
  std::optional<Vec3> along;  ///< fall off in this direction only, constant across it; any length but zero
};

enum class Origin : std::uint8_t { grab, free_edge };

/// What the part's own boundary (free edges) within the selection does.
enum class FreeEnds : std::uint8_t {
  held,      ///< it is a border
  weighted,  ///< it isn't a border; weights fall with the distance from the origin there too
  rigid,     ///< as `weighted`, and what lies between the origin or the axis and a free edge has weight 1
};

struct WeightOptions {
  Falloff falloff;
  FreeEnds free_ends = FreeEnds::rigid;
  Origin origin = Origin::grab;
  /// A piece that no path connects to the grab gets the weights of the closest points of those that WeightPlaces::joined joins it to. The
  /// constant profile doesn't need this.
  bool across_welds = false;
};

/// What weights depend on besides selection, grab and options.
struct WeightPlaces {
  std::optional<Axis> axis;                           ///< of a rotation
  std::optional<NodeIndex> edge;                      ///< origin free_edge: the free edge through this node, or the nearest to it
  const connections::JoinedSheets* joined = nullptr;  ///< for across_welds, which does nothing without
};

struct Weights {
  NodeSet nodes;                ///< the selection
  std::vector<double> weight;   ///< of each, 0..1
  NodeIndex grab;               ///< the one used
  std::size_t unreached = 0;    ///< nodes that no path along the selection (or across welds, if asked) connects to the grab: weight 0,
                                ///< with profile constant 1
  std::size_t free_ending = 0;  ///< nodes of free endings, which free_ends weighted would weight by distance
  NodeIndex edge;               ///< the node through which the origin's free edge was found; invalid: the origin is the grab
  NodeIndex other_edge;         ///< the same with free_ends weighted, if that differs
};

/// Evaluates the profile at d: 1 at the grab, 0 at the border; d is clamped to 0..1, NaN counts as 0. Every profile is 1 at d = 1 and 0 at
/// d = 0, except constant, which is 1 everywhere. The same bits on every processor.
double evaluate(const Falloff& falloff, double d);

/// Computes the weights of a selection. Method: docs/shaping.md.
/// - Border: the selected nodes with a shell that reaches outside the selection; with free ends held also those on free edges.
/// - Origin: the grab. A grab on a free edge (unless free ends are held), or origin free_edge, makes the whole free edge within the
///   selection the origin: in both directions up to a corner of the boundary, without nodes on the border. With rigid free ends a grab on
///   a side, a free edge with one end on the border, takes only what is at least as far from the border.
/// - Rigid free ends: the surface is cut along the origin's distance from the border, or along the axis of a rotation; pieces that are
///   free of the border and have free edges have weight 1 (mesh/shape/free_ending.h).
/// - A grab on the border has weight 1, and so has its free edge; the rest of the border has 0. Without a grab: the node farthest from the
///   border, of equals the first.
/// - A selection without a border has weight 1 at every node that is connected to the grab.
/// - With `along`, distances are measured along this direction from the origin's extent to the border that faces it; the weight stays 1 on
///   a side without such a border.
/// Errors: nothing is selected, the grab isn't selected, origin free_edge without a selected free edge, `along` has no length, flat is
/// outside 0..1.
Result<Weights> compute_weights(const Model& model, const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options,
                                const WeightPlaces& places = {});

}  // namespace prismesh::mesh::shape
