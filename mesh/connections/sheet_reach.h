// How near a node must be to a shell to lie on its sheet without being a corner of it.
#pragma once

#include <cstdint>

#include "mesh/model/model.h"

namespace prismesh::mesh::connections {

/// How a node is attached to a sheet that it is no corner of.
enum class Attachment : std::uint8_t {
  placed,    ///< put onto the flange by position: an end of a weld, which is on a sheet or between two
  tied,      ///< a node of another sheet, tied by a contact: it is offset by half of both thicknesses
  touching,  ///< a node of another sheet whose faces touch, without a card that says so: offset as tied ones
};

/// The reach as a share of the shell's mean side. A node placed on a curved flange is as far from the shell's chord as this allows. Where
/// no thickness is known it is the only measure. Tied nodes are offset by design, therefore they get twice as much.
inline constexpr double kPlacedReachInSides = 0.25;
inline constexpr double kTiedReachInSides = 0.5;
/// The reach in thicknesses of the shell. Placed: the middle of the gap between two sheets that touch is half a thickness away, the middle
/// surface of the other sheet one thickness. Tied: 0.6 times the sum of both thicknesses, which is how far the solver's tied contacts look
/// for a segment [LS-DYNA Keyword]; the tied sheet's thickness is taken to be the same. Sheets that touch have no other measure: without a
/// thickness nothing tells whether they do.
inline constexpr double kPlacedReachInThicknesses = 1.0;
inline constexpr double kTiedReachInThicknesses = 1.2;

/// The max length of a joint between two sheets, in longest sides of the shells at its ends: spot welds, rivets and adhesives span the gap
/// between flanges, which is less than two sides wherever sheets are modelled by shells. What is longer is a strut.
inline constexpr double kMaxJointInSides = 2;

double mean_side(const Model& model, ShellIndex shell);
double max_side(const Model& model, ShellIndex shell);

/// The max distance at which a node lies on the shell, in the deck's length unit: the greater of its two reaches. Touching: by thickness
/// alone, 0 where it isn't known.
double sheet_reach(const Model& model, ShellIndex shell, Attachment attachment);
/// How far a joint at the shell may extend.
double max_joint_length(const Model& model, ShellIndex shell);

}  // namespace prismesh::mesh::connections
