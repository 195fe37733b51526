// What relaxing works on.
#pragma once

#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"
#include "mesh/relax/options.h"
#include "mesh/relax/reference_surface.h"

namespace prismesh::mesh::relax {

struct RelaxInput {
  const Model& model;               ///< with adjacency
  const ReferenceSurface& surface;  ///< covers the shells at movable nodes
  const quality::SizedCriteria& criteria;
  const Options& options;
};

/// Where a hierarchical relaxation begins and how it spreads.
struct SpreadFrom {
  NodeIndex node;
  double threshold = 0;  ///< a node that is displaced by more lets its neighbours move; deck's length unit
};

}  // namespace prismesh::mesh::relax
