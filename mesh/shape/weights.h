// How strongly each selected node follows the grab: d_border / (d_origin + d_border) along the surface, through a profile.
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
  double flat = 0;            ///< 0..1: share of the way from the origin to the border that stays at 1; any profile
  std::optional<Vec3> along;  ///< fall off in this direction only, constant across it; any length but zero
};

enum class Origin : std::uint8_t { grab, free_edge };

struct WeightOptions {
  Falloff falloff;
  bool free_ends = true;  ///< the part's own boundary (free edges) is no border
  Origin origin = Origin::grab;
  /// Pieces that the grab doesn't reach get the weight of the closest point of those it does, if they come near enough; the constant
  /// profile needs none.
  bool across_welds = false;
};

struct Weights {
  NodeSet nodes;               ///< the selection
  std::vector<double> weight;  ///< of each, 0..1
  NodeIndex grab;              ///< the one used
  std::size_t unreached = 0;   ///< nodes with no way from the grab along the selection, nor across welds if asked: weight 0 (1 with
                               ///< profile constant)
};

/// The profile at d (1 at the grab, 0 at the border; arguments beyond count as the nearer end, NaN as 0). Every profile is 1 at
/// d = 1 and 0 at d = 0, except constant, which is 1 everywhere. The same bits on every processor.
double evaluate(const Falloff& falloff, double d);

/// Weights of a selection; the whole definition is in docs/shaping.md.
/// The border is the selection's rim: its nodes with a shell that reaches outside; without free_ends also its nodes on free
/// edges. A grab on a free edge (with free_ends), or origin free_edge, makes that whole free edge within the selection the
/// origin: on both sides up to a corner of the boundary, without nodes on the border. A grab on the border has weight 1 (and
/// so has its free edge), the rest of the border 0. Without a grab: the node farthest from the border, the lowest of equals.
/// A selection without any border has weight 1 everywhere it can be reached. With `along`, distances are measured along that
/// direction from the origin's extent to the border that faces it; a side without such a border doesn't fall off.
/// Errors: empty selection, grab not selected, origin free_edge without a selected free edge, `along` without length, flat
/// outside 0..1.
Result<Weights> compute_weights(const Model& model, const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options);

}  // namespace prismesh::mesh::shape
