// What a relaxing keeps to: distances, rounds, and the criteria that elements are judged by.
#pragma once

#include <optional>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"

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

}  // namespace prismesh::mesh::relax
