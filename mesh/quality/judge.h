// Judges shells by criteria.
#pragma once

#include <span>

#include "mesh/quality/criteria.h"
#include "mesh/quality/limits.h"
#include "mesh/quality/point_shells.h"
#include "mesh/quality/shell_properties.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::quality {

/// Judges one shell's values as measure() gives them. `properties`: of the shell, for criteria that depend on them.
ShellState judge(const Values& values, const SizedCriteria& criteria, const ShellProperties& properties = {});

/// Measures and judges shells given by points. `out` has one entry a shell, `composites` (mesh/quality/composite.h) has as many or none.
void judge_points(const PointShells& shells, const SizedCriteria& criteria, std::span<ShellState> out, std::span<float> composites = {});
/// The same by limits_for() of the criteria, for a caller that judges again and again.
void judge_points(const PointShells& shells, const LimitsByPart& limits, std::span<ShellState> out, std::span<float> composites = {});

}  // namespace prismesh::mesh::quality
