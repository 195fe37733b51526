// Where the model stands before the screen. Screen space is in millimetres: the origin is the screen's centre, x to the right,
// y up, z toward the viewer. All functions are pure.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mesh/model/model.h"

namespace prismesh::kiosk::stereo {

using mesh::Vec3;

/// The depths in which both eyes rest: mm before (+) and behind the screen.
struct ComfortBox {
  double before_mm = 99;
  double behind_mm = 143;
  bool operator==(const ComfortBox&) const = default;
};
/// For eyes at a distance from the screen: parallax e * z / (D - z) within so many degrees as the eyes see it; 1 degree is the usual
/// limit. A box that is wider than half the distance is cut there.
ComfortBox comfort_box(double eye_distance_mm, double degrees = 1, double separation_mm = 63);
/// Share of the comfort box that a model fills at a depth strength of 1.
inline constexpr double kComfortMargin = 0.8;

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 1;
  bool operator==(const Sphere&) const = default;
};

/// An axis-parallel box in deck coordinates; empty when low > high.
struct Box {
  Vec3 low = Vec3::Constant(1e300);
  Vec3 high = Vec3::Constant(-1e300);

  bool empty() const { return !(low.array() <= high.array()).all(); }
  void add(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};
Sphere sphere_around(const Box& box);  ///< radius 1 at the origin for an empty box

struct View {
  Vec3 pivot = Vec3::Zero();                                     ///< deck coordinates; rotations turn about it
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< deck axes to screen axes
  double mm_per_unit = 1;                                        ///< mm on the screen for one deck length unit
  Eigen::Vector2d pan_mm = Eigen::Vector2d::Zero();              ///< where the pivot stands on the screen ...
  double before_mm = 0;                                          ///< ... and how far before it, were depth not compressed
  Sphere bounds;                                                 ///< the whole model, deck coordinates: what must stay in the comfort box
  ComfortBox comfort;
  double depth_strength = 1;  ///< 0: flat; more than 1: up to the comfort box's border
  bool operator==(const View&) const = default;
};

/// Factor on depth alone that keeps `bounds` within the comfort box; never quite 0, so that what lies behind stays behind.
double depth_scale(const View& view);
/// Deck coordinates to screen millimetres, depth compressed: affine.
Eigen::Matrix4d screen_from_deck(const View& view);
Vec3 to_screen(const View& view, const Vec3& deck_point);
Vec3 to_deck(const View& view, const Vec3& screen_mm);
/// The depths that the bounds can reach in screen space: [behind, before] in mm.
std::array<double, 2> depth_extent(const View& view);

/// Turns the model about the pivot: `right` about the screen's vertical, `up` about its horizontal axis, in radians. Follows the hand:
/// a positive `right` moves what is near the viewer to the right.
View orbit(const View& view, double right, double up);
/// Turns about the axis toward the viewer, counterclockwise, in radians.
View roll(const View& view, double angle);
View pan(const View& view, const Eigen::Vector2d& by_mm);
/// Scales by `factor`; what is seen at `at_mm` on the screen stays there.
View zoom(const View& view, double factor, const Eigen::Vector2d& at_mm);
/// Turns about another point from now on; nothing moves.
View with_pivot(const View& view, const Vec3& deck_point);
/// Moves the model in depth by this share of what brings the point into the plane of the screen, and sideways so that an eye goes on
/// seeing it at the same place of the screen.
View toward_screen_plane(const View& view, const Vec3& deck_point, const Vec3& eye_mm, double share = 1);
/// Centres the box and scales it to fill the screen (w x h mm) with a margin, as an eye at `eye_distance_mm` sees it. Keeps the rotation.
View fit(const View& view, const Box& box, const Eigen::Vector2d& screen_mm, double eye_distance_mm = 650);
/// The same for a box whose axes are the screen's: `turned` holds rotation * point of everything. Fits closely from every side.
View fit_turned(const View& view, const Box& turned, const Eigen::Vector2d& screen_mm, double eye_distance_mm = 650);

/// front, back, left, right, top, bottom, iso. Deck z is up; front looks along +y, right along -x, top along -z; iso looks from the
/// right, front and above.
inline constexpr std::array<std::string_view, 7> kViewNames{"front", "back", "left", "right", "top", "bottom", "iso"};
std::optional<Eigen::Quaterniond> named_rotation(std::string_view name);

}  // namespace prismesh::kiosk::stereo
