// Projection through the screen as a window, viewpoints of pictures, projection onto images of any shape, and the pointer's rays.
#include <gtest/gtest.h>

#include "kiosk/stereo/frustum.h"
#include "kiosk/stereo/pointer.h"

namespace prismesh::kiosk::stereo {
namespace {

constexpr double kWidth = 359, kHeight = 287;
const Vec3 kEyes[] = {{0, 0, 650}, {-31.5, 20, 650}, {31.5, 20, 650}, {180, -60, 500}, {-400, 250, 300}};

Eigen::Vector2d project(const Eigen::Matrix4d& clip, const Vec3& mm) {
  const Eigen::Vector4d at = clip * mm.homogeneous();
  return at.head<2>() / at.w();
}

TEST(Frustum, screen_corners_map_to_the_pictures_corners_for_any_eye) {
  for (const Vec3& eye : kEyes) {
    const Eigen::Matrix4d clip = clip_from_screen(eye, {kWidth, kHeight}, {50, 5000});
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0}) {
        const Eigen::Vector2d corner = project(clip, Vec3(sx * kWidth / 2, sy * kHeight / 2, 0));
        EXPECT_NEAR(corner.x(), sx, 1e-12);
        EXPECT_NEAR(corner.y(), sy, 1e-12);
      }
  }
}

TEST(Frustum, parallax_is_that_of_the_eyes_separation) {
  const EyePair eyes = eyes_from({0, 0, 650}, 63);
  EXPECT_DOUBLE_EQ((eyes.right - eyes.left).x(), 63);
  const Eigen::Matrix4d left = clip_from_screen(eyes.left, {kWidth, kHeight}, {50, 5000});
  const Eigen::Matrix4d right = clip_from_screen(eyes.right, {kWidth, kHeight}, {50, 5000});
  for (const double z : {0.0, 50.0, 99.0, -143.0, -300.0}) {
    const double crossed_mm = (project(left, {0, 0, z}).x() - project(right, {0, 0, z}).x()) * kWidth / 2;
    EXPECT_NEAR(crossed_mm, 63 * z / (650 - z), 1e-9) << z;
  }
}

TEST(Frustum, near_and_far_contain_the_views_bounds) {
  View view;
  view.bounds = {{100, 0, 0}, 5000};
  for (const Vec3& eye : kEyes) {
    const DepthRange range = depth_range(view, eye);
    EXPECT_GT(range.near_mm, 0);
    const Eigen::Matrix4d clip = clip_from_screen(eye, {kWidth, kHeight}, range);
    for (const double z : depth_extent(view)) {
      const Eigen::Vector4d at = clip * Vec3(0, 0, z).homogeneous();
      EXPECT_LT(std::abs(at.z()), at.w());
    }
  }
}

TEST(Frustum, an_eye_behind_the_screen_gives_a_finite_projection) {
  for (const double z : {0.0, -50.0})
    EXPECT_TRUE(clip_from_screen({0, 0, z}, {kWidth, kHeight}, depth_range(View(), {0, 0, z})).allFinite());
}

TEST(Frustum, a_projection_is_converted_to_any_affine_image_of_the_picture) {
  const Eigen::Matrix4d clip = clip_from_screen(kEyes[1], {kWidth, kHeight}, {50, 5000});
  EXPECT_TRUE(clip_onto(whole_picture(1280, 1024), clip, 1280, 1024).isApprox(clip, 1e-12)) << "the picture itself";
  ImageMap sheared;
  sheared << 0.003, -0.0004, -0.7, 0, -2.0 / 1024, 1;
  const Eigen::Matrix4d onto = clip_onto(sheared, clip, 1280, 1024);
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(120, -80, 40), Vec3(-150, 100, -90)}) {
    const Eigen::Vector2d at = project(clip, point);
    const Eigen::Vector3d pixel(0.5 * (at.x() + 1) * 1280, 0.5 * (1 - at.y()) * 1024, 1);
    EXPECT_LT((project(onto, point) - sheared * pixel).norm(), 1e-12);
  }
}

TEST(Frustum, pictures_are_drawn_from_a_share_of_the_eyes_separation) {
  PictureEyes eyes{{10, 20, 600}, {3, 4, 0}, 60, 0.5};
  EXPECT_LT((eyes.eyes().right - Vec3(10 + 18, 20 + 24, 600)).norm(), 1e-12);
  EXPECT_LT((eyes.picture_eye(Eye::right) - Vec3(10 + 9, 20 + 12, 600)).norm(), 1e-12);
  EXPECT_EQ(eyes.picture_eye(std::nullopt), eyes.between_mm);
  eyes.depth_share = 0;
  EXPECT_EQ(eyes.picture_eye(Eye::left), eyes.between_mm);
}

Aim some_aim() {
  Aim aim;
  aim.view.rotation = *named_rotation("iso");
  aim.view.pivot = {100, 200, 300};
  aim.view.mm_per_unit = 0.4;
  aim.view.bounds = {{100, 200, 300}, 600};
  aim.eye_mm = {-31.5, 12, 640};
  aim.screen_mm = {500, 280};
  aim.width = 1000;
  aim.height = 560;
  return aim;
}

TEST(Pointer, pixels_count_from_the_upper_left) {
  Aim aim = some_aim();
  aim.view = View();
  EXPECT_LT((*pixel_of(aim, Vec3::Zero()) - Eigen::Vector2d(500, 280)).norm(), 1e-9);
  EXPECT_LT((*pixel_of(aim, Vec3(-250, 140, 0)) - Eigen::Vector2d(0, 0)).norm(), 1e-9);
  EXPECT_LT((mm_of_pixel(aim, {0, 0}) - Eigen::Vector2d(-250, 140)).norm(), 1e-9);
  EXPECT_FALSE(pixel_of(aim, Vec3(0, 0, 700))) << "behind the eye";
}

TEST(Pointer, a_ray_passes_through_the_points_that_project_to_its_pixel) {
  const Aim aim = some_aim();
  const Vec3 point(140, 260, 350);
  const Ray ray = ray_through(aim, *pixel_of(aim, point));
  const Vec3 to_point = point - ray.origin;
  EXPECT_LT(to_point.cross(ray.direction.normalized()).norm(), 1e-7 * to_point.norm());
  EXPECT_GT(to_point.dot(ray.direction), 0);
}

TEST(Pointer, distance_along_an_axis_is_exact) {
  const Aim aim = some_aim();
  const Vec3 point(90, 210, 330), direction = Vec3(0.2, -0.5, 0.9).normalized();
  for (const double distance : {-120.0, 0.0, 3.0, 150.0}) {
    const auto pixel = pixel_of(aim, point + distance * direction);
    EXPECT_NEAR(distance_along(aim, point, direction, *pixel).value(), distance, 1e-7);
  }
}

TEST(Pointer, an_axis_that_points_at_the_eye_gives_no_distance) {
  const Aim aim = some_aim();
  const Vec3 point(90, 210, 330);
  const Vec3 direction = (ray_through(aim, *pixel_of(aim, point)).origin - point).normalized();
  EXPECT_FALSE(distance_along(aim, point, direction, {500, 300}));
}

TEST(Pointer, a_displacement_moves_the_point_under_the_pixel) {
  const Aim aim = some_aim();
  const Vec3 point(90, 210, 330);
  const Eigen::Vector2d pixel(620, 111);
  const Vec3 by = displacement_in_screen_plane(aim, point, pixel);
  EXPECT_LT((*pixel_of(aim, point + by) - pixel).norm(), 1e-7);
  EXPECT_NEAR(to_screen(aim.view, point + by).z(), to_screen(aim.view, point).z(), 1e-9);
}

TEST(Pointer, the_handle_is_picked_where_it_is_drawn) {
  const Aim aim = some_aim();
  const Vec3 point(90, 210, 330);
  const Vec3 sideways = aim.view.rotation.conjugate() * Vec3::UnitX();
  const Vec3 tip = handle_tip(aim, point, sideways);
  EXPECT_NEAR((*pixel_of(aim, tip) - *pixel_of(aim, point)).norm(), kHandleLengthPixels, 1);
  EXPECT_TRUE(on_handle(aim, point, sideways, 0.5 * (*pixel_of(aim, tip) + *pixel_of(aim, point))));
  EXPECT_FALSE(on_handle(aim, point, sideways, *pixel_of(aim, point) + Eigen::Vector2d(0, 40)));
}

}  // namespace
}  // namespace prismesh::kiosk::stereo
