// Chordal deviation: how far edges cut the corners of the surface that the mesh stands for. Definition: docs/quality/metrics.md.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mesh/model/model.h"
#include "mesh/model/node_set.h"

namespace prismesh::mesh::quality {

/// The place of the reference surface that belongs to a point of a shell's edge (a walk from the shell, or the nearest place); nothing if
/// there is none. Asked by several threads at once.
using OnReference = std::function<std::optional<Vec3>(ShellIndex shell, const Vec3& point)>;

/// Of each shell given (all of the model: nullptr; then by ShellIndex): the largest distance of the centres of its edges from the
/// reference, deck's length unit. NaN for a removed shell, one whose coordinates aren't finite, and where there is no reference.
std::vector<float> chordal_deviations(const Model& model, const ShellSet* shells, const OnReference& reference);

}  // namespace prismesh::mesh::quality
