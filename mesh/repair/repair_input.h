// What a repair works on.
#pragma once

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"
#include "mesh/quality/criteria.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/repair/options.h"
#include "mesh/repair/rules.h"

namespace prismesh::mesh::repair {

struct RepairInput {
  const Model& model;                      ///< with adjacency
  const relax::ReferenceSurface& surface;  ///< covers the shells to repair and two rings about them
  const Rules& rules;
  const quality::SizedCriteria& criteria;
  const Options& options;
  NodeSet clusters{};  ///< nodes with too many triangles about them, to be repaired too; ascending
};

}  // namespace prismesh::mesh::repair
