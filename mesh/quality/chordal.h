// Chordal deviation: the distance of edges from the surface that the mesh represents. Definition: docs/quality/metrics.md.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// The point of the reference surface for a point of a shell's edge, or nothing if there is none. Several threads call it at once.
using OnReference = std::function<std::optional<Vec3>(ShellIndex shell, const Vec3& point)>;

/// For each shell given (nullptr: each of the model, by ShellIndex), the max distance of its edges' centres from the reference, in the
/// deck's length unit. NaN for a removed shell, for one whose coordinates aren't finite, and where there is no reference.
std::vector<float> chordal_deviations(const Model& model, const ShellSet* shells, const OnReference& reference);

}  // namespace prismesh::mesh::quality
