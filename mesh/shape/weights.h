// Computes how strongly each selected node follows the grab: a profile of d_border / (d_origin + d_border), distances along the surface.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

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

struct WeightOptions {
  Falloff falloff;
  bool free_ends = true;  ///< the part's own boundary (free edges) doesn't count as a border
  Origin origin = Origin::grab;
  /// A piece that no path connects to the grab gets the weights of the closest points of the connected ones, if it comes near enough. The
  /// constant profile doesn't need this.
  bool across_welds = false;
};

struct Weights {
  NodeSet nodes;               ///< the selection
  std::vector<double> weight;  ///< of each, 0..1
  NodeIndex grab;              ///< the one used
  std::size_t unreached = 0;   ///< nodes that no path along the selection (or across welds, if asked) connects to the grab: weight 0,
                               ///< with profile constant 1
};

/// Evaluates the profile at d: 1 at the grab, 0 at the border; d is clamped to 0..1, NaN counts as 0. Every profile is 1 at d = 1 and 0 at
/// d = 0, except constant, which is 1 everywhere. The same bits on every processor.
double evaluate(const Falloff& falloff, double d);

/// Computes the weights of a selection. Method: docs/shaping.md.
/// - Border: the selected nodes with a shell that reaches outside the selection; without free_ends also those on free edges.
/// - Origin: the grab. A grab on a free edge (with free_ends), or origin free_edge, makes the whole free edge within the selection the
///   origin: in both directions up to a corner of the boundary, without nodes on the border.
/// - A grab on the border has weight 1, and so has its free edge; the rest of the border has 0. Without a grab: the node farthest from the
///   border, of equals the first.
/// - A selection without a border has weight 1 at every node that is connected to the grab.
/// - With `along`, distances are measured along this direction from the origin's extent to the border that faces it; the weight stays 1 on
///   a side without such a border.
/// Errors: nothing is selected, the grab isn't selected, origin free_edge without a selected free edge, `along` has no length, flat is
/// outside 0..1.
Result<Weights> compute_weights(const Model& model, const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options);

}  // namespace prismesh::mesh::shape
