// How near a node must be to a shell to lie on its sheet without being a corner of it.
#pragma once

#include <cstdint>

#include "mesh/model/model.h"

namespace prismesh::mesh::connections {

/// How a node came to a sheet that it is no corner of.
enum class Attachment : std::uint8_t {
  placed,  ///< put onto the flange by position: an end of a weld, which is on a sheet or between two
  tied,    ///< a node of another sheet, tied by a contact: it is offset by half of both thicknesses
};

/// The reach as a share of the shell's mean side. A node placed on a curved flange is as far from the shell's chord as this allows. Where
/// no thickness is known it is the only measure. Tied nodes are offset by design, therefore they get twice as much.
inline constexpr double kPlacedReachInSides = 0.25;
inline constexpr double kTiedReachInSides = 0.5;
/// The reach in thicknesses of the shell. Placed: the middle of the gap between two sheets that touch is half a thickness away, the middle
/// surface of the other sheet one thickness. Tied: 0.6 times the sum of both thicknesses, which is how far the solver's tied contacts look
/// for a segment [LS-DYNA Keyword]; the tied sheet's thickness is taken to be the same.
inline constexpr double kPlacedReachInThicknesses = 1.0;
inline constexpr double kTiedReachInThicknesses = 1.2;

double mean_side(const Model& model, ShellIndex shell);
double max_side(const Model& model, ShellIndex shell);

/// The max distance at which a node lies on the shell, in the deck's length unit: the greater of its two reaches.
double sheet_reach(const Model& model, ShellIndex shell, Attachment attachment);

}  // namespace prismesh::mesh::connections
