// Where *SYSTEM and *INSTANCE put nodes.
#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Geometry>

#include "mesh/deck/abaqus/outline.h"
#include "mesh/deck/data/frame.h"

namespace prismesh::mesh::deck::abaqus {

/// Of SYSTEM= on *NODE: "R", "C" or "S".
Frame::Kind frame_kind(std::string_view system);

/// The system that the data lines of a *SYSTEM give: its origin, a point on its x axis, a point in its xy plane. nullopt: they span none.
std::optional<Eigen::Affine3d> system_of(const DeckOutline& outline, const Block& block);

/// Where the data lines of an *INSTANCE put its part: a translation, then a rotation in degrees about the axis through two points. nullopt:
/// the axis has no direction, or a number can't be read.
std::optional<Eigen::Affine3d> instance_place(const DeckOutline& outline, const Block& block);

}  // namespace prismesh::mesh::deck::abaqus
