// The data that the stages of a repair share.
#pragma once

#include "mesh/quality/limits.h"
#include "mesh/relax/reference_surface.h"
#include "mesh/repair/options.h"
#include "mesh/repair/patch.h"

namespace prismesh::mesh::repair {

struct RepairContext {
  Patch& patch;
  const relax::ReferenceSurface& surface;
  const quality::SizedCriteria& criteria;
  const Options& options;
  quality::LimitsByPart limits;  ///< that shells are judged by: the criteria's, or stricter ones
};

}  // namespace prismesh::mesh::repair
