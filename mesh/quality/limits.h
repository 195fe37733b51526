// The limits that hold for one shell, for whoever says how far beyond them a value is.
#pragma once

#include "mesh/quality/criteria.h"

namespace prismesh::mesh::quality {

/// What judge() compares a value of the metric with, in the metric's unit: lengths follow the target size, the least min_length also what
/// the criteria ask for by the shell's thickness and by a wanted time step. `sheet` as in judge().
Threshold limits_of(const Criteria& criteria, Metric metric, bool of_triangle, double target_size, const Sheet& sheet = {});

}  // namespace prismesh::mesh::quality
