// Placement of the model in front of the screen, and its limits in depth.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "kiosk/stereo/view.h"

namespace prismesh::kiosk::stereo {
namespace {

View some_view() {
  View view;
  view.pivot = {10, -20, 30};
  view.rotation = *named_rotation("iso");
  view.mm_per_unit = 0.25;
  view.pan_mm = {12, -7};
  view.bounds = {{12, -18, 33}, 400};
  return view;
}

Vec3 on_screen(std::string_view name, const Vec3& deck) {
  View view;
  view.rotation = *named_rotation(name);
  return to_screen(view, deck);
}

TEST(View, named_views_have_their_direction) {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  EXPECT_TRUE(on_screen("front", z).isApprox(y)) << "up is up";
  EXPECT_TRUE(on_screen("front", y).isApprox(-z)) << "looking along +y";
  EXPECT_TRUE(on_screen("back", y).isApprox(z));
  EXPECT_TRUE(on_screen("right", x).isApprox(z));
  EXPECT_TRUE(on_screen("right", z).isApprox(y));
  EXPECT_TRUE(on_screen("left", x).isApprox(-z));
  EXPECT_TRUE(on_screen("top", z).isApprox(z));
  EXPECT_TRUE(on_screen("top", y).isApprox(y));
  EXPECT_TRUE(on_screen("bottom", z).isApprox(-z));
  for (const std::string_view name : kViewNames) EXPECT_NEAR(named_rotation(name)->toRotationMatrix().determinant(), 1, 1e-12) << name;
  const Vec3 iso = on_screen("iso", Vec3(1, -1, 1));
  EXPECT_NEAR(iso.z(), std::sqrt(3.0), 1e-12) << "from the right, front and above";
  EXPECT_FALSE(named_rotation("sideways"));
}

TEST(View, to_deck_inverts_to_screen) {
  const View view = some_view();
  const Vec3 point(123, 45, -6);
  EXPECT_LT((to_deck(view, to_screen(view, point)) - point).norm(), 1e-9);
  const Eigen::Vector4d by_matrix = screen_from_deck(view) * point.homogeneous();
  EXPECT_LT((by_matrix.head<3>() - to_screen(view, point)).norm(), 1e-9);
  EXPECT_LT((to_screen(view, view.pivot) - Vec3(12, -7, 0)).norm(), 1e-12) << "the pivot lies in the screen's plane";
}

TEST(View, the_model_stays_in_the_comfort_box_for_every_rotation_and_zoom) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 2000; ++round) {
    View view = some_view();
    view = orbit(view, 3 * unit(random), 3 * unit(random));
    view = zoom(view, std::exp(6 * unit(random)), {50 * unit(random), 50 * unit(random)});
    view = with_pivot(view, view.bounds.centre + view.bounds.radius * Vec3(unit(random), unit(random), unit(random)));
    view = toward_screen_plane(view, view.bounds.centre + view.bounds.radius * Vec3(unit(random), unit(random), unit(random)),
                               {80 * unit(random), 0, 650});
    view.comfort = comfort_box(650 + 250 * unit(random), 1 + 0.5 * unit(random));
    view.depth_strength = 0.75 + 0.75 * unit(random);
    const Vec3 direction = Vec3(unit(random), unit(random), unit(random)).normalized();
    const double z = to_screen(view, view.bounds.centre + view.bounds.radius * direction).z();
    ASSERT_LE(z, view.comfort.before_mm + 1e-9);
    ASSERT_GE(z, -view.comfort.behind_mm - 1e-9);
    const auto [behind, before] = depth_extent(view);
    ASSERT_LE(z, before + 1e-9);
    ASSERT_GE(z, behind - 1e-9);
  }
}

TEST(View, small_models_keep_their_true_depth) {
  View view;
  view.bounds = {Vec3::Zero(), 10};
  EXPECT_EQ(depth_scale(view), 1);
  view.mm_per_unit = 100;
  EXPECT_LT(depth_scale(view), 0.1);
}

TEST(View, orbit_moves_the_near_side_with_the_pointer) {
  View view;
  const Vec3 near_point(0, 0, 5);
  EXPECT_GT(to_screen(orbit(view, 0.1, 0), near_point).x(), 0);
  EXPECT_GT(to_screen(orbit(view, 0, 0.1), near_point).y(), 0);
  EXPECT_GT(to_screen(roll(view, 0.1), Vec3(5, 0, 0)).y(), 0);
  const View there_and_back = orbit(orbit(some_view(), 0.3, 0), -0.3, 0);
  EXPECT_TRUE(there_and_back.rotation.isApprox(some_view().rotation, 1e-12));
}

TEST(View, zoom_keeps_what_is_under_the_pointer) {
  const View view = some_view();
  const Eigen::Vector2d at(33, -12);
  const Vec3 under = to_deck(view, Vec3(at.x(), at.y(), 0));
  EXPECT_LT((to_screen(zoom(view, 3.7, at), under).head<2>() - at).norm(), 1e-9);
}

TEST(View, a_new_pivot_moves_nothing) {
  const View view = some_view();
  const Vec3 point(50, 60, 70);
  const View moved = with_pivot(view, Vec3(-5, 8, 13));
  EXPECT_LT((to_screen(moved, point) - to_screen(view, point)).norm(), 1e-9);
  EXPECT_LT((to_deck(moved, to_screen(view, point)) - point).norm(), 1e-9);
  EXPECT_LT((screen_from_deck(moved) - screen_from_deck(view)).norm(), 1e-9);
  const Vec3 pivot = to_screen(moved, Vec3(-5, 8, 13));
  const View turned = orbit(moved, 0.4, 0.2);
  EXPECT_LT((to_screen(turned, Vec3(-5, 8, 13)).head<2>() - pivot.head<2>()).norm(), 1e-9) << "turns about it";
}

TEST(View, zoom_keeps_the_plane_of_the_screen) {
  const View view = toward_screen_plane(some_view(), Vec3(100, 50, -30), {0, 0, 650});
  EXPECT_NEAR(to_screen(zoom(view, 2.5, {10, 20}), Vec3(100, 50, -30)).z(), 0, 1e-9);
}

Eigen::Vector2d seen_on_screen(const View& view, const Vec3& eye, const Vec3& deck) {
  const Vec3 mm = to_screen(view, deck);
  return eye.head<2>() + (mm.head<2>() - eye.head<2>()) * eye.z() / (eye.z() - mm.z());
}

TEST(View, a_point_moves_into_the_screen_plane_where_the_eye_sees_it) {
  const Vec3 eye(70, -20, 600), point(150, -60, 210);
  View view = some_view();
  const Eigen::Vector2d seen = seen_on_screen(view, eye, point);
  ASSERT_GT(std::abs(to_screen(view, point).z()), 5);
  for (int step = 0; step < 4; ++step) {
    view = toward_screen_plane(view, point, eye, 0.5);
    EXPECT_LT((seen_on_screen(view, eye, point) - seen).norm(), 1e-9) << step;
  }
  view = toward_screen_plane(view, point, eye);
  EXPECT_NEAR(to_screen(view, point).z(), 0, 1e-9);
  EXPECT_LT((to_screen(view, point).head<2>() - seen).norm(), 1e-9);
}

TEST(View, the_comfort_box_is_a_degree_of_parallax) {
  const ComfortBox box = comfort_box(650);
  EXPECT_NEAR(box.before_mm, 99, 0.5);
  EXPECT_NEAR(box.behind_mm, 143, 0.5);
  for (const double distance : {400.0, 550.0, 800.0, 1000.0}) {
    const ComfortBox at = comfort_box(distance, 1, 63);
    EXPECT_NEAR(63 * at.before_mm / (distance - at.before_mm), distance * std::tan(std::numbers::pi / 180), 1e-9);
    EXPECT_NEAR(63 * at.behind_mm / (distance + at.behind_mm), distance * std::tan(std::numbers::pi / 180), 1e-9);
  }
  EXPECT_LE(comfort_box(3000, 3).behind_mm, 1500) << "limited, as the eyes would have to diverge";
  EXPECT_GT(comfort_box(650, 1.5).before_mm, box.before_mm);
}

TEST(View, the_comfort_box_reaches_max_half_the_eyes_distance) {
  // 1 degree at 2 m is 35 mm of parallax: with eyes 63 mm apart that is 2.48 m behind the screen.
  EXPECT_DOUBLE_EQ(comfort_box(2000, 1, 63).behind_mm, 1000);
  EXPECT_LT(comfort_box(2000, 1, 63).before_mm, 1000);
  // 20 degrees at 650 mm are 237 mm of parallax: 514 mm in front of the screen.
  EXPECT_DOUBLE_EQ(comfort_box(650, 20, 63).before_mm, 325);
  EXPECT_DOUBLE_EQ(comfort_box(650, 20, 63).behind_mm, 325);
}

TEST(View, depth_strength_scales_depth_up_to_the_comfort_box) {
  View view = some_view();
  view.bounds.radius = 40;  // 10 mm on the screen: true depth
  EXPECT_EQ(depth_scale(view), 1);
  view.depth_strength = 0.5;
  EXPECT_NEAR(depth_scale(view), 0.5, 1e-12);
  view.depth_strength = 1.5;
  EXPECT_NEAR(depth_scale(view), 1.5, 1e-12);
  view.depth_strength = 0;
  EXPECT_GT(depth_scale(view), 0) << "can still be inverted";
  EXPECT_LT(depth_extent(view)[1], 0.1);
  view.bounds.radius = 4000;
  view.depth_strength = 1;
  const double fitted = depth_scale(view);
  view.depth_strength = 1.5;
  EXPECT_GT(depth_scale(view), 1.2 * fitted);
  EXPECT_LE(depth_extent(view)[1], view.comfort.before_mm + 1e-9);
}

TEST(View, fit_fills_the_screen_and_keeps_the_rotation) {
  Box box;
  box.add(Vec3(1000, -50, 3));
  box.add(Vec3(1400, 80, 20));
  for (const std::string_view name : kViewNames) {
    View view;
    view.rotation = *named_rotation(name);
    view.bounds = sphere_around(box);
    const Eigen::Vector2d screen(500, 300);
    view = fit(view, box, screen);
    EXPECT_TRUE(view.rotation.isApprox(*named_rotation(name)));
    Eigen::Vector2d extent = Eigen::Vector2d::Zero();
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 mm = to_screen(view, Vec3(corner & 1 ? 1000 : 1400, corner & 2 ? -50 : 80, corner & 4 ? 3 : 20));
      extent = extent.cwiseMax((mm.head<2>() * 650 / (650 - mm.z())).cwiseAbs());
    }
    EXPECT_LE(extent.x(), 250) << name;
    EXPECT_LE(extent.y(), 150) << name;
    EXPECT_GT(std::max(extent.x() / 250, extent.y() / 150), 0.8) << name;
  }
}

TEST(View, fit_of_an_empty_box_is_a_valid_view) {
  const View view = fit(View(), Box(), {500, 300});
  EXPECT_TRUE(std::isfinite(view.mm_per_unit));
  EXPECT_GT(view.mm_per_unit, 0);
  Box point;
  point.add(Vec3(5, 5, 5));
  EXPECT_TRUE(std::isfinite(fit(View(), point, {500, 300}).mm_per_unit));
}

}  // namespace
}  // namespace prismesh::kiosk::stereo
