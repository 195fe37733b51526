// How strongly each selected node follows the grab: d_border / (d_origin + d_border) along the surface, through a profile.
#pragma once

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

struct Falloff {
  Profile profile = Profile::smooth;
  double flat = 0;            ///< 0..1: share of the weight's range around the grab that stays at 1 (gaussian)
  std::optional<Vec3> along;  ///< fall off in this direction only, constant across it
};

enum class Origin : std::uint8_t { grab, free_edge };

struct WeightOptions {
  Falloff falloff;
  bool free_ends = true;  ///< the part's own boundary is no border
  Origin origin = Origin::grab;
};

struct Weights {
  NodeSet nodes;               ///< the selection
  std::vector<double> weight;  ///< of each, 0..1
  NodeIndex grab;              ///< the one used
  std::size_t unreached = 0;   ///< nodes with no way from the grab along the selection: weight 0
};

/// The profile at d (1 at the grab, 0 at the border).
double evaluate(const Falloff& falloff, double d);

/// Weights of a selection. The border is the selection's rim without the part's own boundary (with free_ends); a grab on a
/// free edge, or origin free_edge, makes that whole free edge (within the selection) the origin; a grab on the border has
/// weight 1, the rest of the border 0. Without a grab: the node farthest from the border.
/// A selection without any border has weight 1 everywhere it can be reached.
/// Errors: empty selection, grab not selected.
Result<Weights> compute_weights(const Model& model, const NodeSet& selection, std::optional<NodeIndex> grab, const WeightOptions& options);

}  // namespace prismesh::mesh::shape
