// One figure for an element and for a part: how far it is from failing. Definition: docs/quality/README.md.
#pragma once

#include <span>

#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"
#include "mesh/quality/sheet.h"

namespace prismesh::mesh::quality {

/// 1: ideal by every metric the criteria judge; 0: at the fail limit of the worst one; below 0 it fails, the worse the nearer to -1. An
/// element with a defect (Defect) has -1, nothing else has. Never NaN. `sheet` as in judge(). Metrics without a fail limit don't count.
float composite(const Values& values, const SizedCriteria& criteria, const Sheet& sheet = {});

/// The same of shells of a model, measured in batches; `out` has one entry each. Removed shells have 1. `values`: their metrics too, as
/// measure_shells() gives them, or none. Of shells given by points: judge_points().
void composites(const Model& model, std::span<const ShellIndex> shells, const SizedCriteria& criteria, std::span<float> out,
                std::span<Values> values = {});

}  // namespace prismesh::mesh::quality
