// The stable time step of a shell in explicit integration.
#pragma once

#include <optional>
#include <span>

#include "mesh/model/model.h"

namespace prismesh::mesh::quality {

/// Characteristic length of a shell (3 or 4 corners) as *CONTROL_TIMESTEP's ISDO chooses it: 0 area over the longest side,
/// 1 area over the longest diagonal, 2 the larger of 0 and the shortest side; a triangle's area counts twice. Any other value counts as 0.
/// Source: LS-DYNA theory manual, "Time step size control".
double characteristic_length(std::span<const Vec3> corners, int shell_option);

/// The wave speed in a part's material that limits the time step, deck's units: a plate's, sqrt(E / (rho (1 - nu^2))), or with ISDO 2 a
/// bar's, sqrt(E / rho). Nothing if the material is unknown or doesn't limit the step (rigid, null). Source: LS-DYNA keyword manual,
/// *CONTROL_TIMESTEP.
std::optional<double> wave_speed(const Part& part, int shell_option = 0);

/// Characteristic length over wave speed, without TSSFAC, in the deck's time unit. Nothing if the part's material is unknown or doesn't
/// limit the step, the shell has no area (Defect::no_area) or its coordinates aren't finite.
std::optional<double> shell_time_step(const Part& part, std::span<const Vec3> corners, int shell_option);

}  // namespace prismesh::mesh::quality
