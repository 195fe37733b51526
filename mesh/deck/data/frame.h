// Converts between the coordinate system of a node's card and the basic system, which the model uses. Such systems come from Nastran's CORD
// cards, LS-DYNA's *INCLUDE_TRANSFORM, Radioss's /TRANSFORM and units, Abaqus's *SYSTEM.
#pragma once

#include <optional>

#include <Eigen/Geometry>

namespace prismesh::mesh::deck {

struct Frame {
  enum class Kind : std::uint8_t { rectangular, cylindrical, spherical };
  Kind kind = Kind::rectangular;
  /// From the frame's own rectangular coordinates to the basic system. It may scale and shear, and needn't be invertible.
  Eigen::Affine3d to_basic = Eigen::Affine3d::Identity();

  bool is_basic() const { return kind == Kind::rectangular && to_basic.matrix() == Eigen::Matrix4d::Identity(); }
};

/// Converts a card's coordinates to the basic system. `card`: cylindrical: radius, angle (degrees), z; spherical: radius, angle from z
/// (degrees), angle about z (degrees); lengths in the card's own unit.
Eigen::Vector3d to_basic(const Frame& frame, const Eigen::Vector3d& card);

/// Converts a point in the basic system to a card's coordinates. `near`: the card as it was; angles get the value, of those that differ by
/// whole turns, nearest to that of `near`, and on the axis, where they are undefined, that of `near`. nullopt: the frame can't be inverted.
std::optional<Eigen::Vector3d> to_card(const Frame& frame, const Eigen::Vector3d& basic, const Eigen::Vector3d& near);

}  // namespace prismesh::mesh::deck
