// Relaxing: nodes find better places on the surface they are on. Method and source: docs/relaxing.md.
#pragma once

#include <optional>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/criteria.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::relax {

struct Options {
  double feature_angle = 30;              ///< degrees
  std::optional<double> most_on_surface;  ///< no node inside a sheet moves farther; deck's length unit
  std::optional<double> most_on_line;     ///< no node on a feature line moves farther
  /// Of each of the model's nodes: the place that both count from, of which it is no farther now; one that isn't finite has no limit.
  /// Null: where the node is.
  const std::vector<Vec3>* limits_from = nullptr;
  int most_rounds = 200;
  /// Look on the way whether elements got worse, and let their nodes go on with care: rests sooner in rough meshes. Without, only at rest:
  /// what stretches a long way shares its length with elements that are too long for a while.
  bool checks_on_the_way = true;
};

/// What elements are judged by: nothing that passes may fail afterwards.
struct Judge {
  const quality::Criteria& criteria;
  double target_size = 1;
};

struct Relaxed {
  NodeSet nodes;                ///< that moved
  std::vector<Vec3> positions;  ///< of each
  int rounds = 0;
  bool converged = false;
  std::size_t held_back = 0;  ///< nodes that would have made an element worse than it may become
  std::size_t limited = 0;    ///< nodes that stopped at most_on_surface or most_on_line
  double farthest = 0;        ///< the greatest displacement
};

/// Relaxes `movable` nodes; every other node stays. Deterministic, whatever the number of threads. Afterwards no metric of a shell fails or
/// warns that didn't, and the least composite (mesh/quality/composite.h) isn't lower. Errors: cancelled.
/// Preconditions: the model has its adjacency; nodes whose coordinates mustn't change aren't in `movable`; `surface` covers the shells
/// that touch it.
Result<Relaxed> relax(const Model& model, const ReferenceSurface& surface, const NodeSet& movable, const Judge& judge,
                      const Options& options, const Progress& progress = {});

/// Hierarchical: begins with `at` and the nodes around it; the neighbours of a node join while it is displaced by more than `threshold`
/// (deck's length unit). Otherwise as relax.
Result<Relaxed> relax_from(const Model& model, const ReferenceSurface& surface, NodeIndex at, double threshold, const NodeSet& movable,
                           const Judge& judge, const Options& options, const Progress& progress = {});

}  // namespace prismesh::mesh::relax
