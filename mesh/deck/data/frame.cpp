#include "mesh/deck/data/frame.h"

#include <cmath>

namespace prismesh::mesh::deck {
namespace {

constexpr double kDegrees = M_PI / 180;
/// Below this share of the matrix's largest entry cubed, a volume counts as flattened.
constexpr double kFlat = 1e-12;

/// The angle (degrees) that differs by whole turns and lies nearest to `near`.
double turned_near(double degrees, double near) { return degrees + 360 * std::round((near - degrees) / 360); }

}  // namespace

Eigen::Vector3d to_basic(const Frame& frame, const Eigen::Vector3d& card) {
  Eigen::Vector3d own = card;
  if (frame.kind == Frame::Kind::cylindrical) {
    own = {card[0] * std::cos(card[1] * kDegrees), card[0] * std::sin(card[1] * kDegrees), card[2]};
  } else if (frame.kind == Frame::Kind::spherical) {
    const double across = card[0] * std::sin(card[1] * kDegrees);
    own = {across * std::cos(card[2] * kDegrees), across * std::sin(card[2] * kDegrees), card[0] * std::cos(card[1] * kDegrees)};
  }
  return frame.to_basic * own;
}

std::optional<Eigen::Vector3d> to_card(const Frame& frame, const Eigen::Vector3d& basic, const Eigen::Vector3d& near) {
  const Eigen::Matrix3d linear = frame.to_basic.linear();
  const double size = linear.cwiseAbs().maxCoeff();
  if (!(std::abs(linear.determinant()) > kFlat * size * size * size)) return std::nullopt;
  const Eigen::Vector3d own = frame.to_basic.inverse() * basic;
  if (frame.kind == Frame::Kind::rectangular) return own;

  const double across = std::hypot(own.x(), own.y());
  const double about = across > 0 ? std::atan2(own.y(), own.x()) / kDegrees : 0;
  if (frame.kind == Frame::Kind::cylindrical) return Eigen::Vector3d(across, across > 0 ? turned_near(about, near[1]) : near[1], own.z());
  const double radius = own.norm();
  const double from_z = radius > 0 ? std::atan2(across, own.z()) / kDegrees : near[1];
  return Eigen::Vector3d(radius, from_z, across > 0 ? turned_near(about, near[2]) : near[2]);
}

}  // namespace prismesh::mesh::deck
