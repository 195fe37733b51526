// The system in which a node's card gives its coordinates: Nastran's CORD cards, an include that LS-DYNA transforms, Abaqus's *SYSTEM.
// The model has everything in the basic system.
#pragma once

#include <optional>

#include <Eigen/Geometry>

namespace prismesh::mesh::deck {

struct Frame {
  enum class Kind : std::uint8_t { rectangular, cylindrical, spherical };
  Kind kind = Kind::rectangular;
  /// From the frame's own right-angled coordinates to the basic system; may scale and shear, so it need not be invertible.
  Eigen::Affine3d to_basic = Eigen::Affine3d::Identity();

  bool is_basic() const { return kind == Kind::rectangular && to_basic.matrix() == Eigen::Matrix4d::Identity(); }
};

/// A card's coordinates in the basic system. Cylindrical: radius, angle (degrees), z. Spherical: radius, angle from z (degrees),
/// angle about z (degrees). Lengths in the card's own unit.
Eigen::Vector3d to_basic(const Frame& frame, const Eigen::Vector3d& card);

/// The other way. Of an angle's many values the one nearest to that of `near` (the card as it was), which also decides on the axis,
/// where angles mean nothing. nullopt: the frame can't be inverted.
std::optional<Eigen::Vector3d> to_card(const Frame& frame, const Eigen::Vector3d& basic, const Eigen::Vector3d& near);

}  // namespace prismesh::mesh::deck
