// Depth as the user wants it, in virtual time: stronger and weaker, level with the selection, fitted to the eyes' distance.
#include <cmath>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "kiosk/toolkit/depth.h"

namespace prismesh::kiosk::toolkit {
namespace {

using stereo::to_screen;
using stereo::Vec3;
using stereo::View;

constexpr std::int64_t kMs = 1'000'000;
const Vec3 kEyes(40, 10, 650);

View some_view() {
  View view;
  view.rotation = *stereo::named_rotation("iso");
  view.bounds = {{0, 0, 0}, 50};
  return view;
}

TEST(DepthFit, the_point_glides_into_the_plane_without_moving_sideways) {
  ManualClock clock;
  DepthFit fit;
  const Vec3 point(30, -25, 20);
  View view = fit.fitted(some_view(), kEyes, clock.now_ns());
  const auto seen = [&] {
    const Vec3 mm = to_screen(view, point);
    return Eigen::Vector2d(kEyes.head<2>() + (mm.head<2>() - kEyes.head<2>()) * kEyes.z() / (kEyes.z() - mm.z()));
  };
  const Eigen::Vector2d at = seen();
  const double depth = to_screen(view, point).z();
  ASSERT_GT(std::abs(depth), 15);
  fit.bring(point, clock.now_ns());
  EXPECT_TRUE(fit.moving());
  double last = std::abs(depth);
  for (int frame = 0; frame < 13; ++frame) {
    clock.advance_ns(16 * kMs);
    view = fit.fitted(view, kEyes, clock.now_ns());
    const double now = std::abs(to_screen(view, point).z());
    EXPECT_LE(now, last + 1e-9);
    EXPECT_LT(last - now, 0.25 * std::abs(depth)) << "no jump";
    EXPECT_LT((seen() - at).norm(), 1e-6);
    last = now;
  }
  EXPECT_FALSE(fit.moving()) << "within 200 ms";
  EXPECT_NEAR(to_screen(view, point).z(), 0, 1e-9);
}

TEST(DepthFit, the_user_turns_the_view_meanwhile) {
  ManualClock clock;
  DepthFit fit;
  const Vec3 point(30, -25, 20);
  View view = fit.fitted(some_view(), kEyes, clock.now_ns());
  fit.bring(point, clock.now_ns());
  while (fit.moving()) {
    clock.advance_ns(16 * kMs);
    view = stereo::orbit(stereo::zoom(view, 1.02, {0, 0}), 0.01, 0);
    view = fit.fitted(view, kEyes, clock.now_ns());
  }
  EXPECT_NEAR(to_screen(view, point).z(), 0, 1e-9);
}

TEST(DepthFit, strength_and_comfort_keep_their_limits) {
  DepthFit fit;
  fit.change_percent(100);
  EXPECT_EQ(fit.percent(), 150);
  fit.change_percent(-100);
  EXPECT_EQ(fit.percent(), 0);
  fit.change_degrees(100);
  EXPECT_DOUBLE_EQ(fit.degrees(), 1.5);
  fit.change_degrees(-100);
  EXPECT_DOUBLE_EQ(fit.degrees(), 0.5);
}

TEST(DepthFit, wider_comfort_gives_a_large_model_more_depth) {
  DepthFit fit;
  View view = some_view();
  view.bounds.radius = 1000;
  const double before = stereo::depth_scale(fit.fitted(view, kEyes, 0));
  fit.change_degrees(3);
  EXPECT_NEAR(stereo::depth_scale(fit.fitted(view, kEyes, 0)) / before, 1.3, 0.07);
}

TEST(DepthFit, follows_the_eyes_distance_in_steps) {
  ManualClock clock;
  DepthFit fit;
  const View view = some_view();
  const double first = fit.fitted(view, {0, 0, 650}, clock.now_ns()).comfort.before_mm;
  for (int i = 0; i < 200; ++i) {  // swaying by 4 cm
    clock.advance_ns(16 * kMs);
    EXPECT_EQ(fit.fitted(view, {0, 0, 650 + 40 * std::sin(0.1 * i)}, clock.now_ns()).comfort.before_mm, first);
  }
  EXPECT_FALSE(fit.moving());
  double last = first;
  for (int i = 0; i < 13; ++i) {  // leaning in
    const double now = fit.fitted(view, {0, 0, 500}, clock.now_ns()).comfort.before_mm;
    EXPECT_LE(now, last);
    EXPECT_LT(last - now, 0.2 * first);
    last = now;
    clock.advance_ns(16 * kMs);
  }
  EXPECT_NEAR(last, stereo::comfort_box(500).before_mm, 1e-9);
  EXPECT_FALSE(fit.moving());
}

}  // namespace
}  // namespace prismesh::kiosk::toolkit
