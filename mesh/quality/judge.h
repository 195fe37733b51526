// Judges shells by criteria.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"
#include "mesh/quality/sheet.h"
#include "mesh/quality/shell_state.h"

namespace prismesh::mesh::quality {

/// Judges one shell's values as measure() gives them. `sheet` counts where the criteria look at it.
ShellState judge(const Values& values, const Criteria& criteria, double target_size, const Sheet& sheet = {});

/// Measures and judges shells given by points, for a drag or a trial: corner >= 0 is moving[corner], < 0 is fixed[~corner]; a triangle
/// repeats its third. `sheets` has one entry a shell, or is empty if unknown. `out` has one entry a shell, `composites`
/// (mesh/quality/composite.h) too or none.
void judge_points(std::span<const Vec3> moving, std::span<const Vec3> fixed, std::span<const std::array<std::int32_t, 4>> corners,
                  std::span<const Sheet> sheets, const Criteria& criteria, double target_size, std::span<ShellState> out,
                  std::span<float> composites = {});

}  // namespace prismesh::mesh::quality
