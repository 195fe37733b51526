// Options of relaxing: distances and rounds.
#pragma once

#include <optional>
#include <vector>

#include "mesh/model/model.h"

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

}  // namespace prismesh::mesh::relax
