// Composite quality of an element: one figure for how far it is from failing. Definition: docs/quality/README.md.
#pragma once

#include <span>

#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"
#include "mesh/quality/shell_properties.h"

namespace prismesh::mesh::quality {

/// 1: ideal by every metric that the criteria judge; 0: at the fail limit of the worst metric; below 0: it fails, the worse the nearer to
/// -1. Only an element with a defect (Defect) has -1. Never NaN. Metrics without a fail limit don't count. `properties`: as in judge().
float composite(const Values& values, const SizedCriteria& criteria, const ShellProperties& properties = {});

/// The composites of shells of a model; `out` has an entry for each, 1 for removed shells. `values`: receives their metrics too, as
/// measure_shells() gives them; or empty. For shells given by points: judge_points().
void composites(const Model& model, std::span<const ShellIndex> shells, const SizedCriteria& criteria, std::span<float> out,
                std::span<Values> values = {});

}  // namespace prismesh::mesh::quality
