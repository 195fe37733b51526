// Places the model in front of the screen. Screen space is in millimetres: the origin is the screen's centre, x to the right, y up, z
// toward the viewer. All functions are pure.
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

/// Range of depths that are comfortable for both eyes: mm in front of and behind the screen, both positive.
struct ComfortBox {
  double before_mm = 99;
  double behind_mm = 143;
  bool operator==(const ComfortBox&) const = default;
};
/// The comfort box for eyes at a distance D from the screen: parallax e * z / (D - z) of at most `degrees`; 1 degree is the usual limit.
/// Both depths are at most half the distance.
ComfortBox comfort_box(double eye_distance_mm, double degrees = 1, double separation_mm = 63);
/// Share of the comfort box that a model fills at depth strength 1.
inline constexpr double kComfortMargin = 0.8;

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius = 1;
  bool operator==(const Sphere&) const = default;
};

/// An axis-parallel box in deck coordinates; empty if low > high.
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
/// The sphere through the box's corners. For an empty box the unit sphere at the origin.
Sphere sphere_around(const Box& box);

struct View {
  Vec3 pivot = Vec3::Zero();                                     ///< deck coordinates; rotations turn about it
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< deck axes to screen axes
  double mm_per_unit = 1;                                        ///< mm on the screen for one deck length unit
  Eigen::Vector2d middle_mm = Eigen::Vector2d::Zero();           ///< the middle of the room that panels leave on the screen
  Eigen::Vector2d pan_mm = Eigen::Vector2d::Zero();              ///< position of the pivot on the screen, from `middle_mm` ...
  double before_mm = 0;                                          ///< ... and its distance in front of it, before depth is compressed
  Sphere bounds;  ///< around the whole model, deck coordinates; it must stay in the comfort box
  ComfortBox comfort;
  double depth_strength = 1;  ///< 0: flat; above 1: up to the comfort box's border
  bool operator==(const View&) const = default;
};

/// Factor on depth alone that keeps `bounds` within the comfort box. Always above 0, so that the order in depth stays.
double depth_scale(const View& view);
/// Affine map from deck coordinates to screen millimetres, with compressed depth.
Eigen::Matrix4d screen_from_deck(const View& view);
Vec3 to_screen(const View& view, const Vec3& deck_point);
Vec3 to_deck(const View& view, const Vec3& screen_mm);
/// Min and max depth of the bounds in screen space, mm.
std::array<double, 2> depth_extent(const View& view);

/// Turns the model about the pivot: `right` about the screen's vertical axis, `up` about its horizontal one, in radians. A positive `right`
/// moves what is near the viewer to the right.
View orbit(const View& view, double right, double up);
/// Turns the model about the axis toward the viewer, counterclockwise, in radians.
View roll(const View& view, double angle);
/// Moves the model parallel to the screen.
View pan(const View& view, const Eigen::Vector2d& by_mm);
/// Scales the model by `factor` about the point `at_mm` of the screen.
View zoom(const View& view, double factor, const Eigen::Vector2d& at_mm);
/// Changes the pivot of later rotations; nothing moves.
View with_pivot(const View& view, const Vec3& deck_point);
/// Moves the model in depth by `share` of what brings the point into the screen's plane, and sideways so that the eye sees the point at the
/// same position of the screen.
View toward_screen_plane(const View& view, const Vec3& deck_point, const Vec3& eye_mm, double share = 1);
/// Centres the box in the view's middle and scales it to fill a room of w x h mm there with a margin, for an eye at `eye_distance_mm`.
/// Keeps the rotation.
View fit(const View& view, const Box& box, const Eigen::Vector2d& screen_mm, double eye_distance_mm = 650);
/// The same for the box around rotation * point of all points (`turned`). It is tighter than a box along the deck's axes.
View fit_turned(const View& view, const Box& turned, const Eigen::Vector2d& screen_mm, double eye_distance_mm = 650);

/// Deck z is up; front looks along +y, right along -x, top along -z; iso looks from the
/// right, front and above.
inline constexpr std::array<std::string_view, 7> kViewNames{"front", "back", "left", "right", "top", "bottom", "iso"};
/// The rotation of a name in kViewNames.
std::optional<Eigen::Quaterniond> named_rotation(std::string_view name);

}  // namespace prismesh::kiosk::stereo
