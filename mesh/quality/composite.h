// One figure for an element and for a part: how far it is from failing. Definition: docs/quality/README.md.
#pragma once

#include "mesh/quality/criteria.h"

namespace prismesh::mesh::quality {

/// 1: ideal by every metric the criteria judge; 0: at the fail limit of the worst one; below 0 it fails, down to -1. An element with a
/// defect (Defect) has -1. Never NaN. `thickness` as in judge().
float composite(const Values& values, const Criteria& criteria, double target_size, double thickness = 0);

}  // namespace prismesh::mesh::quality
