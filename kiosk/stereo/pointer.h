// Converts between the pointer's pixel and the scene: the eye's ray through a pixel, and the distance of a drag.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "kiosk/stereo/frustum.h"
#include "kiosk/stereo/profile.h"
#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::stereo {

/// View, eye and screen of a picture of width x height pixels, for the pointer. Pixels count from the upper left corner; the centre of the
/// first is (0.5, 0.5).
struct Aim {
  View view;
  Vec3 eye_mm = Vec3(0, 0, 650);
  Eigen::Vector2d screen_mm = Eigen::Vector2d(1, 1);
  int width = 1;
  int height = 1;

  Eigen::Matrix4d clip_from_deck() const;
  double mm_per_pixel() const { return screen_mm.x() / width; }
};
/// The aim of a profile's pointer eye (from between the eyes for Weave::centre), for a picture in the middle of the screen. `eyes` is
/// relative to the screen's centre.
Aim aim_for(const View& view, const Profile& profile, const PictureEyes& eyes, int width, int height);

/// The matrix of a view in which a plane takes the place of the near plane, or of the far one if the eye is below it: what lies above the
/// plane, along `normal`, is clipped. Depth keeps its order [Lengyel 2005]. The same matrix if the plane goes through the eye or clips all.
Eigen::Matrix4d clip_with_cut(const Aim& aim, const Vec3& point, const Vec3& normal);

/// Pixel of a deck point; empty if it is behind the eye.
std::optional<Eigen::Vector2d> pixel_of(const Aim& aim, const Vec3& deck_point);
/// Position of a pixel on the screen, mm.
Eigen::Vector2d mm_of_pixel(const Aim& aim, const Eigen::Vector2d& pixel);

/// A ray in deck coordinates. `direction` isn't a unit vector.
struct Ray {
  Vec3 origin = Vec3::Zero();
  Vec3 direction = Vec3::UnitZ();
};
Ray ray_through(const Aim& aim, const Eigen::Vector2d& pixel);

/// Distance along the unit vector `direction` from `point` (deck coordinates) at which the axis is nearest to the pointer on the screen;
/// empty if the axis points nearly at the eye, where the distance is undefined.
std::optional<double> distance_along(const Aim& aim, const Vec3& point, const Vec3& direction, const Eigen::Vector2d& pixel);
/// The displacement, parallel to the screen, that moves `point` under the pixel (deck coordinates).
Vec3 displacement_in_screen_plane(const Aim& aim, const Vec3& point, const Eigen::Vector2d& pixel);

/// Length of the handle's arrow on the screen, in pixels, if it is parallel to the screen.
inline constexpr double kHandleLengthPixels = 96;
/// The tip (deck coordinates) of the arrow of a handle at `point` along `direction`.
Vec3 handle_tip(const Aim& aim, const Vec3& point, const Vec3& direction);
/// Whether a pixel is on the handle's arrow or at most `slack` pixels beside it.
bool on_handle(const Aim& aim, const Vec3& point, const Vec3& direction, const Eigen::Vector2d& pixel, double slack = 8);

}  // namespace prismesh::kiosk::stereo
