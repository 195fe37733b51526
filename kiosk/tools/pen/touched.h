// What the pen touches, and what it would take. The model isn't trusted.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "kiosk/render/model_source.h"

namespace prismesh::kiosk::tools::pen {

using mesh::Vec3;

/// The shell that the pen's process says it touches (its index), if it is there: no farther from `at` than `reach`, both of the deck. The
/// process may still feel another state of the model, or another place of it, than the one that is shown.
std::optional<mesh::ShellIndex> touched_shell(const render::ModelSource& model, std::int32_t element, const Vec3& at, double reach);

/// The corner of a shell of the model that is nearest.
mesh::NodeIndex nearest_corner(const render::ModelSource& model, mesh::ShellIndex shell, const Vec3& at);

/// Its edges.
std::vector<std::array<Vec3, 2>> edges_of(const render::ModelSource& model, mesh::ShellIndex shell);

/// The nearest node within `reach` that a shell of a visible part has. Costs a pass over the nodes and, where some are near, over the
/// shells.
std::optional<mesh::NodeIndex> nearest_node(const render::ModelSource& model, const Vec3& at, double reach);

}  // namespace prismesh::kiosk::tools::pen
